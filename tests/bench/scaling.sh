#!/usr/bin/env bash
# Time and memory of `idim generate` over the number of joints: chains of 2 to 50 revolute joints and the trees of humanoid.yaml and humanoid.urdf.
# Usage: scaling.sh COMMAND FOLDER. Prints a table, the fitted exponent and a plot; FOLDER gets scaling.dat and scaling.svg.
# User time, the least of three runs: what else the machine does counts less in it than in the time on the wall.
set -euo pipefail
idim=$1
folder=$2
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$folder"

chain() { # JOINTS -> description; parallel, perpendicular and again perpendicular axes in turn
    echo "name: chain$1"
    echo "joints:"
    awk -v n="$1" 'BEGIN {
        split("0 pi/2 -pi/2", alpha, " ")
        for (i = 1; i <= n; ++i)
            printf "  - {name: j%d, alpha: %s, d: %.2f, theta: q, r: %.2f}\n", i, alpha[(i - 1) % 3 + 1], i == 1 ? 0 : 0.1 + 0.01 * (i - 1),
                   i % 2 == 0 ? 0.05 : 0
    }'
}

measure() { # DESCRIPTION -> seconds kilobytes
    for _ in 1 2 3; do
        env time -f "%U %M" -o "$work/time" "$idim" generate "$1" -o "$work/model" >/dev/null
        cat "$work/time"
    done | sort -n | head -1
}

printf '%-13s %6s %10s %8s\n' robot joints "user [s]" "RSS [MB]"
report() { # ROBOT JOINTS DESCRIPTION: a line of the table, and one of the data
    read -r seconds kilobytes <<<"$(measure "$3")"
    printf '%-13s %6d %10.2f %8.0f\n' "$1" "$2" "$seconds" "$((kilobytes / 1024))"
    echo "$2 $seconds $((kilobytes / 1024))" >>"$folder/scaling.dat"
}

rm -f "$folder/scaling.dat"
for joints in 2 3 4 5 6 7 8 10 12 15 20 25 30 35 40 45 50; do
    chain "$joints" >"$work/chain.yaml"
    report chain "$joints" "$work/chain.yaml"
done
printf '\n\n' >>"$folder/scaling.dat" # separates the data sets
report humanoid 50 "$here/humanoid.yaml"
report humanoid_urdf 50 "$here/humanoid.urdf"
gnuplot -e "folder='$folder'" "$here/scaling.gnuplot"
