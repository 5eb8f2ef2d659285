#!/usr/bin/env bash
# The tree that `cmake --install` lays down: complete, and free to be moved.
. "$(dirname "$0")/support.sh"

Installs() {
    rm -rf "$WORK/first" "$tree"
    mkdir -p "$WORK"
    cmake --install "$BUILD" --prefix "$WORK/first" >"$WORK/install.log"
    mv "$WORK/first" "$tree"
}

NamesNoFolderItWasBuiltIn() {
    local found
    for folder in "$SOURCE" "$BUILD" "$WORK"; do
        found=$(grep -rlF -- "$folder" "$tree" || true)
        same "files that name $folder" "" "$found"
    done
}

CommandFindsItsTemplates() {
    (cd / && env -i "$idim" generate "$tree/share/idim/robots/scara/scara.yaml" -o "$WORK/scara") >/dev/null
    diff -r "$WORK/scara" "$SOURCE/generated/scara" || fail "another model than in the sources"
    (cd / && env -i "$idim" generate "$tree/share/idim/robots/scara/scara.yaml" -o "$WORK/scara_c" --target c) >/dev/null
    diff -r "$WORK/scara_c" "$SOURCE/generated/scara_c" || fail "another model in C than in the sources"
}

LinkToTheCommandFindsThemToo() {
    ln -sf "$idim" "$WORK/linked_idim"
    env -i "$WORK/linked_idim" base "$tree/share/idim/robots/scara/scara.yaml" >/dev/null || fail "templates not found through a link"
}

TemplatesOfTheEnvironmentComeFirst() {
    rm -rf "$WORK/templates"
    cp -r "$tree/share/idim/templates" "$WORK/templates"
    echo "// mine" >>"$WORK/templates/cpp/functions.hpp.mustache"
    IDIM_TEMPLATES=$WORK/templates "$idim" generate "$tree/share/idim/robots/emps/emps.yaml" -o "$WORK/emps" >/dev/null
    contains "$WORK/emps/functions.hpp" "// mine"
    ! IDIM_TEMPLATES=$WORK/none "$idim" base "$tree/share/idim/robots/emps/emps.yaml" 2>"$WORK/error" || fail "no folder, no error"
    contains "$WORK/error" "cannot find the templates that IDIM_TEMPLATES names, looked for cpp/function.hpp.mustache in $WORK/none"
}

# simulate compiles the model at run time: the headers come from the installed tree.
CommandCompilesModels() {
    rm -rf "$WORK/cache" "$WORK/log.csv"
    awk -v phase=1 -v seconds=2 -f "$SOURCE/runtime/demo/scara_reference.awk" >"$WORK/reference.csv"
    env -i PATH="$PATH" XDG_CACHE_HOME="$WORK/cache" "$idim" simulate "$tree/share/idim/robots/scara/scara.yaml" \
        --parameters "$SOURCE/runtime/demo/scara_truth.yaml" --reference "$WORK/reference.csv" -o "$WORK/log.csv" >/dev/null
    [ -s "$WORK/log.csv" ] || fail "no log"
    [ -d "$WORK/cache/idim" ] || fail "no compiled model"
}

# configure TEXT [OPTION...]: a project of these lines after find_package's prefix is set; output in $WORK/configure/log.
configure() {
    local project=$WORK/configure/project
    rm -rf "$WORK/configure"
    mkdir -p "$project"
    printf 'cmake_minimum_required(VERSION 3.25)\nproject(p LANGUAGES %s)\n%s\n' "${languages:-NONE}" "$1" >"$project/CMakeLists.txt"
    cmake -S "$project" -B "$WORK/configure/build" -DCMAKE_PREFIX_PATH="$tree" "${@:2}" >"$WORK/configure/log" 2>&1
}

refused() { # TEXT MESSAGE [OPTION...]
    ! configure "$1" "${@:3}" || fail "accepted: $1"
    tr -s ' \n' ' ' <"$WORK/configure/log" >"$WORK/configure/line"
    contains "$WORK/configure/line" "$2"
}

FindPackageSaysWhatIsMissing() {
    local arm=(-DCMAKE_SYSTEM_NAME=Generic -DCMAKE_SYSTEM_PROCESSOR=arm)
    refused 'find_package(idim REQUIRED COMPONENTS solver)' "component solver: it has the components generator and runtime"
    refused 'find_package(idim 9 REQUIRED)' 'compatible with requested version "9"'
    refused 'find_package(idim REQUIRED COMPONENTS runtime)' "component runtime: its runtime was built for Linux" "${arm[@]}"
    refused 'find_package(idim REQUIRED)' "/nowhere/idim does not run on this machine: set IDIM_EXECUTABLE" \
        -DIDIM_EXECUTABLE=/nowhere/idim
    printf '#!/bin/sh\necho 0.0.1\n' >"$WORK/old_idim"
    chmod +x "$WORK/old_idim"
    refused 'find_package(idim REQUIRED)' "$WORK/old_idim is idim 0.0.1, expected" -DIDIM_EXECUTABLE="$WORK/old_idim"
}

CrossCompilingTakesTheGeneratorOfThisMachine() {
    local arm=(-DCMAKE_SYSTEM_NAME=Generic -DCMAKE_SYSTEM_PROCESSOR=arm)
    local show='get_target_property(command idim::idim IMPORTED_LOCATION)
message(STATUS "generator: ${command}")
if(TARGET idim::runtime)
  message(FATAL_ERROR "a runtime of another machine")
endif()'
    configure "find_package(idim REQUIRED)
$show" "${arm[@]}" || { cat "$WORK/configure/log"; fail "package of this machine"; }
    contains "$WORK/configure/log" "generator: $idim"
    # The package in a file system of the target: its command does not run here, the one on the PATH does.
    rm -rf "$WORK/target_tree"
    cp -r "$tree" "$WORK/target_tree"
    echo "not a program of this machine" >"$WORK/target_tree/bin/idim"
    PATH=$tree/bin:$PATH configure "find_package(idim REQUIRED COMPONENTS generator)
$show" "${arm[@]}" -DCMAKE_PREFIX_PATH="$WORK/target_tree" || { cat "$WORK/configure/log"; fail "package of the target"; }
    contains "$WORK/configure/log" "generator: $idim"
}

IdimGenerateSaysWhatIsWrong() {
    local start='find_package(idim REQUIRED COMPONENTS generator)
file(WRITE ${CMAKE_BINARY_DIR}/t.cpp "int t;")
add_library(t ${CMAKE_BINARY_DIR}/t.cpp)
'
    local languages=CXX
    mkdir -p "$WORK/twin"
    cp "$tree/share/idim/robots/emps/emps.yaml" "$WORK/twin"
    refused "${start}idim_generate(TARGET t)" "expected TARGET <target> ROBOT <robot.yaml | robot.urdf>"
    refused "${start}idim_generate(TARGET t ROBOT \${IDIM_ROBOTS}/emps/emps.yaml LANGUAGE ada)" "[LANGUAGE cpp|c]"
    refused "${start}idim_generate(TARGET t ROBOT \${IDIM_ROBOTS}/emps/emps.yaml COST gpu)" "[COST ops|x86|mcu]"
    refused "${start}idim_generate(TARGET t ROBOT \${IDIM_ROBOTS}/emps/emps.yaml LANGUAGE c)" "C among its LANGUAGES"
    refused "${start}idim_generate(TARGET none ROBOT \${IDIM_ROBOTS}/emps/emps.yaml)" "idim_generate: no target none"
    refused "${start}idim_generate(TARGET t ROBOT nowhere.yaml)" "idim_generate: no file"
    refused "${start}idim_generate(TARGET t ROBOT \${IDIM_ROBOTS}/emps/emps.yaml)" "needs idim::runtime, which is not here"
    refused "${start}idim_generate(TARGET t ROBOT \${IDIM_ROBOTS}/emps/emps.yaml HEADERS_ONLY)
idim_generate(TARGET t ROBOT $WORK/twin/emps.yaml HEADERS_ONLY)" "idim_generate: two robots called emps"
}

UrdfThatARobotNamesIsADependency() {
    local robots=$WORK/urdf_robots languages=CXX
    mkdir -p "$robots/meshes"
    printf '<robot name="plain-arm"/>\n' | tee "$robots/plain.urdf" >"$robots/meshes/arm.urdf"
    printf 'name: arm\nurdf: "meshes/arm.urdf"  # beside its meshes\n' >"$robots/arm.yaml"
    configure "find_package(idim REQUIRED COMPONENTS generator)
file(WRITE \${CMAKE_BINARY_DIR}/t.cpp \"int t;\")
add_library(t \${CMAKE_BINARY_DIR}/t.cpp)
idim_generate(TARGET t ROBOT $robots/plain.urdf HEADERS_ONLY)
idim_generate(TARGET t ROBOT $robots/arm.yaml HEADERS_ONLY)" -G Ninja || { cat "$WORK/configure/log"; fail "does not configure"; }
    for pair in plain:plain.urdf arm:meshes/arm.urdf arm:arm.yaml; do
        ninja -C "$WORK/configure/build" -t query "idim_models/cpp/${pair%:*}/generated.stamp" >"$WORK/configure/log"
        contains "$WORK/configure/log" "$robots/${pair#*:}"
    done
}

"$1"
