#!/usr/bin/env bash
# Figures that are measured, not tested. Usage: bench.sh COMMAND SOURCE_FOLDER
# Operations of the rigid models of every robot (inverse dynamics, regressor, inertia matrix, direct model; multiplications and additions,
# divisions left out) beside published counts: those of OpenSYMORO, and the lowest we know. Then what the cost models of --cost choose, and the
# time to generate all models of the robot as declared.
set -euo pipefail
idim=$1
source=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

opensymoro() { # ROBOT -> four counts, - where none is known
    case $1 in
    scara) echo "19*11 14*8 8*5 50*31" ;;
    denso_vp6242g) echo "297*237 601*359 223*152 967*713" ;;
    puma560) echo "301*240 628*381 247*163 948*701" ;;
    rx90) echo "287*226 577*336 195*133 858*622" ;;
    stanford) echo "262*211 444*265 147*105 728*536" ;;
    kuka_lwr) echo "343*271 801*456 269*181 1018*746" ;;
    *) echo "- - - -" ;;
    esac
}

lowest() { # ROBOT -> four counts, - where none is known
    case $1 in
    scara) echo "19*11 14*8 4*3 22*12" ;;
    denso_vp6242g) echo "257*238 395*298 140*122 476*410" ;;
    puma560) echo "259*240 394*297 154*132 490*420" ;;
    rx90) echo "247*228 367*272 129*109 455*387" ;;
    stanford) echo "228*209 340*249 105*90 408*347" ;;
    kuka_lwr) echo "297*275 644*460 178*144 595*505" ;;
    *) echo "- - - -" ;;
    esac
}

count() { # JSON MODEL -> mul*add of the rigid model
    awk -v model="\"$2\":" '/"rigid"/ { rigid = 1 } rigid && $1 == model { found = 1 } found && $1 == "\"mul\":" { m = $2 + 0 }
        found && $1 == "\"add\":" { printf "%d*%d", m, $2 + 0; exit }' "$1"
}

counts() { # JSON -> the four counts
    for model in inverse_dynamics regressor mass_matrix forward_dynamics; do
        printf '%s ' "$(count "$1" "$model")"
    done
}

row() { printf '%-15s %-12s %12s %12s %14s %13s  %s\n' "$@"; }

row robot counts "inverse dyn." regressor "inertia matrix" "direct model" "seconds (all models)"
for description in "$source"/robots/*/*.yaml; do
    robot=$(basename "$(dirname "$description")")
    [ "$(basename "$description")" = "$robot.yaml" ] || continue
    for cost in ops x86 mcu; do
        "$idim" generate "$description" -o "$work/$robot" --cost "$cost" --json "$work/$cost.json" >/dev/null
    done
    # shellcheck disable=SC2046 # four words each
    row "$robot" ours $(counts "$work/ops.json") "$(awk '/"seconds"/ { print $2 + 0 }' "$work/ops.json")"
    for other in opensymoro lowest; do
        # shellcheck disable=SC2046
        [ "$($other "$robot")" = "- - - -" ] || row "" "$other" $($other "$robot") ""
    done
    for cost in x86 mcu; do
        # shellcheck disable=SC2046
        [ "$(counts "$work/$cost.json")" = "$(counts "$work/ops.json")" ] || row "" "for $cost" $(counts "$work/$cost.json") ""
    done
done
