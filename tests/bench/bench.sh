#!/usr/bin/env bash
# Figures that are measured, not tested. Usage: bench.sh COMMAND SOURCE_FOLDER
# Operations of the rigid models of every robot beside the lowest published counts we know (symbolic robot generators: inverse dynamics,
# regressor, inertia matrix, direct model; multiplications and additions), and the time to generate all models of the robot as declared.
set -euo pipefail
idim=$1
source=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

published() { # ROBOT -> four counts, - where none is known
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

printf '%-15s %-24s %-24s %-24s %-24s %s\n' robot "inverse dynamics" regressor "inertia matrix" "direct model" "seconds (all models)"
printf '%-15s %-24s %-24s %-24s %-24s\n' "" "ours (published)" "ours (published)" "ours (published)" "ours (published)"
for description in "$source"/robots/*/*.yaml; do
    robot=$(basename "$(dirname "$description")")
    [ "$(basename "$description")" = "$robot.yaml" ] || continue
    "$idim" generate "$description" -o "$work/$robot" --json "$work/$robot.json" >/dev/null
    read -r id w m d <<<"$(published "$robot")"
    file=$work/$robot.json
    printf '%-15s %-24s %-24s %-24s %-24s %s\n' "$robot" "$(count "$file" inverse_dynamics) ($id)" "$(count "$file" regressor) ($w)" \
        "$(count "$file" mass_matrix) ($m)" "$(count "$file" forward_dynamics) ($d)" \
        "$(awk '/"seconds"/ { print $2 + 0 }' "$file")"
done
