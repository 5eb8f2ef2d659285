#!/usr/bin/env bash
# The chain end to end: description -> base parameters -> code -> simulated log -> identification -> validation, then the measured
# robots where their logs are present. Usage: demo.sh COMMAND SOURCE_FOLDER
set -euo pipefail
idim=$1
source=$2
data=${IDIM_DATA:-$source/../shared/data}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

say() { printf '\n== %s\n' "$*"; }

robot=$source/robots/scara/scara.yaml
truth=$source/runtime/demo/scara_truth.yaml

say "Base parameters of the SCARA"
"$idim" base "$robot"

say "Generated code"
"$idim" generate "$robot" -o "$work/scara"

say "Two motions simulated in closed loop with noise, at the published parameters"
for run in 1 2; do
    awk -v phase=$run -v seconds=120 -f "$source/runtime/demo/scara_reference.awk" > "$work/reference_$run.csv"
    "$idim" simulate "$robot" --parameters "$truth" --reference "$work/reference_$run.csv" -o "$work/log_$run.csv" \
        --position-noise 1e-4 --torque-noise 0.4 0.08 --seed $run
done

say "Identified from the first, beside the truth"
"$idim" identify "$robot" "$work/log_1.csv" --method wls --truth "$truth" --json "$work/result.json"

say "Validated on the second"
"$idim" validate "$robot" "$work/result.json" "$work/log_2.csv" --json "$work/validation.json"

measured() { # ROBOT METHOD IDENTIFICATION_LOG [VALIDATION_LOG]
    local description=$source/robots/$1/$1.yaml
    if [ ! -r "$3" ]; then
        say "Measured $1: skipped, $3 is not here"
        return
    fi
    say "Measured $1"
    "$idim" identify "$description" "$3" --method "$2" --json "$work/$1.json"
    if [ $# -gt 3 ]; then
        "$idim" validate "$description" "$work/$1.json" "$4"
    fi
}

measured emps ols "$data/emps/ident.csv.gz"
measured tx40 wls "$data/tx40/ident.csv.gz"
measured panda wls "$data/panda/ident.csv.gz" "$data/panda/valid.csv.gz"

# The loop closed: a twin of the SCARA whose second joint pulls at a spring that the description does not have.
say "A twin with a spring at joint 2 that its description lacks, simulated"
cp "$source/robots/scara/direct_drive_rotor.yaml" "$work"
sed 's/^effects:/effects:\n  - {effect: spring, joints: [j2]}/' "$robot" >"$work/twin.yaml"
{ cat "$truth"; echo "K2: 0.5"; echo "K02: 0"; } >"$work/twin_truth.yaml"
for run in 1 2; do
    "$idim" simulate "$work/twin.yaml" --parameters "$work/twin_truth.yaml" --reference "$work/reference_$run.csv" -o "$work/twin_$run.csv" \
        --position-noise 1e-4 --torque-noise 0.4 0.08 --seed $run
done

say "What the description lacks is found, added, and everything identified again"
"$idim" refine "$robot" "$work/twin_1.csv" --validation "$work/twin_2.csv" -o "$work/refined"

say "The diff of the generated model"
cat "$work/refined/model.diff"
