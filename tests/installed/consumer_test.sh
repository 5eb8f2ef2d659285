#!/usr/bin/env bash
# tests/consumer, a project of its own, built from the installed tree alone. Of tree and robots it has copies to change.
# CMAKE_GENERATOR says by which build program.
. "$(dirname "$0")/support.sh"

mine=$WORK/consumer-${CMAKE_GENERATOR// /-}
build=$mine/build
models=$build/idim_models/cpp/scara

run_build() { cmake --build "$build" --parallel 2 "$@" >"$mine/build.log" 2>&1 || { cat "$mine/build.log"; fail "does not build"; }; }

# When each result of the build was last written: models, objects, programs.
results() {
    find "$build" -path "$build/CMakeFiles/3*" -prune -o -type f \( -name '*.o' -o -name '*.[ch]pp' -o -perm -u+x \) \
        -printf '%P %T@\n' | sort
}

stamp() { stat -c %Y.%y "$models/generated.stamp"; }

motion() { printf 't,q1,q2,qd1,qd2,qdd1,qdd2\n0,0.3,-1.2,0.7,0.2,-1.1,2\n0.1,0.4,1.1,-0.7,0.3,1.5,-2\n'; }

torques() { "$build/torque" "$mine/motion.csv"; }

Builds() {
    rm -rf "$mine"
    mkdir -p "$mine"
    cp -r "$tree" "$mine/tree"
    cp -r "$tree/share/idim/robots" "$mine/robots"
    motion >"$mine/motion.csv"
    cmake -S "$SOURCE/tests/consumer" -B "$build" -DCMAKE_PREFIX_PATH="$mine/tree" -DROBOTS="$mine/robots" >"$mine/configure.log" \
        || { cat "$mine/configure.log"; fail "does not configure"; }
    run_build
}

GivesTheTorquesOfTheClosedForm() {
    same "torques" "$(awk -F, -f "$SOURCE/tests/installed/scara_torque.awk" "$mine/motion.csv")" "$(torques)"
}

CProgramGivesTheInertiaOfTheClosedForm() {
    local q2
    for q2 in 0 0.7 -2.1; do
        same "inertia at q2 = $q2" "$(awk -v q2=$q2 'BEGIN {
            ZZ1 = 3.44; ZZ2 = 0.062; coupling = 0.5 * (0.242 * cos(q2) - 0.014 * sin(q2))
            printf "%.5g %.5g %.5g\n", ZZ1 + ZZ2 + 2 * coupling, ZZ2 + coupling, ZZ2 }')" "$("$build/inertia" $q2)"
    done
}

IdentifiesWithTheModelsCompiledIn() { "$build/identifiers/built_in_model_test" || fail "built_in_model_test"; }

SecondBuildDoesNothing() {
    run_build
    local before
    before=$(results; stamp)
    run_build
    same "a second build wrote files" "$before" "$(results; stamp)"
}

RobotTouchedButEqualRecompilesNothing() {
    run_build
    local before=$(results) generated=$(stamp)
    touch "$mine/robots/scara/scara.yaml"
    run_build
    [ "$(stamp)" != "$generated" ] || fail "the generator did not run"
    same "files written although nothing changed" "$before" "$(results)"
}

GeneratorThatIsNewerRunsAgain() {
    run_build
    local before=$(results) generated=$(stamp)
    touch "$mine/tree/bin/idim"
    run_build
    [ "$(stamp)" != "$generated" ] || fail "the generator did not run"
    same "files written although nothing changed" "$before" "$(results)"
}

program=torque # the one that recompiles looks at

# recompiles FILE SED_SCRIPT: a change of FILE compiles and links the program again; it is taken back in the end. Leaves the torques
# that the changed program gave in $changed_torques.
recompiles() {
    run_build --target torque inertia
    local before
    before=$(results | grep "$program")
    cp "$1" "$mine/original"
    sed -i "$2" "$1"
    ! cmp -s "$1" "$mine/original" || fail "no change of $1 by $2"
    run_build --target torque inertia
    changed_torques=$(torques)
    ! join <(echo "$before") <(results | grep "$program") | awk '$2 == $3' | grep . || fail "not written again after a change of $1"
    cp "$mine/original" "$1"
    run_build --target torque inertia
}

ChangedConstantRelinks() {
    run_build
    local before rx90
    before=$(torques)
    rx90=$(results | grep rx90)
    recompiles "$mine/robots/scara/scara.yaml" 's/L: 0.5/L: 0.6/'
    [ "$before" != "$changed_torques" ] || fail "the program is as before"
    program=inertia
    recompiles "$mine/robots/scara/scara.yaml" 's/L: 0.5/L: 0.6/'
    same "the change was not taken back" "$before" "$(torques)"
    same "files of the other robot were written" "$rx90" "$(results | grep rx90)"
}

ChangedEffectRelinks() {
    recompiles "$mine/robots/scara/direct_drive_rotor.yaml" 's/^torque: \(.*\)/torque: 2 * (\1)/'
    recompiles "$mine/tree/share/idim/templates/effects/coulomb_friction.yaml" 's/^torque: \(.*\)/torque: 2 * (\1)/'
    [ "$(torques)" != "$changed_torques" ] || fail "twice the dry friction, and the program is as before"
}

ChangedTemplateRelinks() { recompiles "$mine/tree/share/idim/templates/cpp/functions.hpp.mustache" '$a // mine'; }

# A file of the model that the build does not know would not be made again where it is lost, and Ninja would compile against an old one.
BuildKnowsEveryFileOfTheManifest() {
    local folder file
    for folder in idim_models/cpp/scara idim_models/c/scara; do
        file=
        for file in $(sed -n '/"files"/,/]/s/^ *"\([^"]*\.[ch]p*\)",*$/\1/p' "$build/$folder/manifest.json"); do
            ninja -C "$build" -t query "$folder/$file" >/dev/null || fail "idim_generate does not list $file"
        done
        [ -n "$file" ] || fail "no files in $folder/manifest.json"
    done
}

# Both models come from one URDF: a change of it makes both again, and their users, in one run of the build.
UrdfRobotsAreGeneratedAgainToo() {
    mine=$WORK/consumer-urdf
    build=$mine/build
    rm -rf "$mine"
    cp -r "$SOURCE/tests/consumer/urdf" "$mine"
    if ! "$idim" base "$mine/two-arm.urdf" >/dev/null 2>&1; then
        echo "skipped: this generator does not read URDF"
        exit 77
    fi
    cmake -S "$mine" -B "$build" -DCMAKE_PREFIX_PATH="$tree" >"$mine/configure.log" || { cat "$mine/configure.log"; fail "does not configure"; }
    run_build
    local before again
    before=$("$build/inputs")
    sed -i 's/xyz="0.4 0 0"/xyz="0.5 0 0"/' "$mine/two-arm.urdf"
    run_build
    again=$(join -v 1 <(sort <<<"$before") <("$build/inputs" | sort) | wc -l)
    same "models generated again" 2 "$again"
}

BuildsWithPkgConfig() {
    rm -rf "$mine"
    cp -r "$SOURCE/tests/consumer" "$mine"
    motion >"$mine/motion.csv"
    PKG_CONFIG_PATH=$tree/lib/pkgconfig make -C "$mine" >"$mine/build.log" 2>&1 || { cat "$mine/build.log"; fail "does not build"; }
    build=$mine GivesTheTorquesOfTheClosedForm
}

"$1"
