#!/usr/bin/env bash
# tests/firmware, built for a Cortex-M4F with the generator of the installed tree, and run in QEMU. Called as
# firmware_test.sh CLAIM|Table, with SOURCE, BUILD and WORK in the environment (see ../installed/support.sh).
. "$(dirname "$0")/../installed/support.sh"

sources=$SOURCE/tests/firmware
build=$WORK/firmware
elf=$build/firmware.elf
printed=$build/printed
compare=$BUILD/bin/firmware_compare
unset CMAKE_CXX_COMPILER_LAUNCHER CXX CMAKE_GENERATOR

for program in arm-none-eabi-g++ qemu-system-arm; do
    if ! command -v $program >/dev/null; then
        echo "skipped: no $program (Debian packages gcc-arm-none-eabi, libstdc++-arm-none-eabi-newlib, qemu-system-arm)"
        exit 77
    fi
done

Builds() {
    rm -rf "$build"
    mkdir -p "$build"
    cmake -S "$sources" -B "$build" -G Ninja --toolchain "$sources/cortex-m4f.cmake" -DCMAKE_PREFIX_PATH="$tree" \
        >"$build/log" 2>&1 || { cat "$build/log"; fail "does not configure"; }
    cmake --build "$build" --parallel 2 >"$build/log" 2>&1 || { cat "$build/log"; fail "does not build"; }
}

# With -icount shift=0 every instruction takes 1 ns of the board's time, whatever the machine below is doing.
Runs() {
    timeout 300 qemu-system-arm -M mps2-an386 -nographic -monitor none -serial none -icount shift=0 \
        -semihosting-config enable=on,target=native -kernel "$elf" >"$printed" 2>&1 </dev/null || { tail -c 500 "$printed"; fail "the run"; }
    contains "$printed" "done"
}

GivesTheSameOnEveryRun() {
    cp "$printed" "$build/printed_before"
    Runs
    cmp "$printed" "$build/printed_before" || fail "another run printed something else"
}

CounterCountsInstructions() { contains "$printed" "counted 200 for 200 nops"; }

AgreesWithTheHostToFloatRounding() { "$compare" <"$printed" || fail "comparison with double precision"; }

# The comparison itself: a result that is off by 2^-11 of itself does not pass.
ComparisonSeesAWrongResult() {
    awk '/^call rx90 c inverse_dynamics/ && !n++ {
             last = substr($NF, 6, 1)
             $NF = substr($NF, 1, 4) (last < 8 ? "f" : "0") substr($NF, 6)
         } { print }' "$printed" >"$build/wrong"
    ! cmp -s "$printed" "$build/wrong" || fail "nothing was changed"
    ! "$compare" <"$build/wrong" >"$build/log" || fail "accepted"
    contains "$build/log" "FAILED"
}

symbols() { arm-none-eabi-nm "$@"; }

# Nothing that allocates, throws, guards statics, calls constructors of statics, or computes in double precision by the library.
NeedsNoHeapNoExceptionsNoDoubles() {
    local unwanted
    unwanted=$(symbols "$elf" | grep -E ' (_?malloc|_?free|_?realloc|_?calloc|_?sbrk|_Zn|_Zd|__cxa|__gxx|_Unwind|__aeabi_unwind|__aeabi_d|__aeabi_[fuil]+2d|__.*df[23]|__aeabi_atexit|_impure|__errno)' || true)
    same "symbols of the program" "" "$unwanted"
    same "initialised data" "" "$(arm-none-eabi-size -A "$elf" | awk '$1 == ".data" && $2 > 0')"
    ! grep -q 'libstdc++' "$build/firmware.map" || fail "libstdc++ was linked"
}

# Generated code keeps nothing between calls: its objects have neither data nor zeroed memory.
GeneratedCodeHasNoState() {
    local objects
    objects=$(find "$build/CMakeFiles" -name '*.obj' | grep -E 'idim_models|_cpp\.cpp')
    same "objects with data" "" "$(arm-none-eabi-size $objects | awk 'NR > 1 && $2 + $3 > 0')"
}

# frames: lines "symbol frame worst" of every function, from the machine code (stack.awk).
frames() {
    arm-none-eabi-objdump -d --no-show-raw-insn "$elf" | awk -f "$sources/stack.awk" >"$build/frames" || fail "stack.awk"
    sort "$build/frames"
}

# The compiler's own account of each function's frame (-fstack-usage) is what stack.awk reads from the machine code.
FramesAreThoseOfTheCompiler() {
    find "$build/CMakeFiles" -name '*_f.c.su' -exec cat {} + | sed 's/.*:\([a-z0-9_]*\)\t\([0-9]*\)\tstatic$/\1 \2/' | sort >"$build/su"
    join "$build/su" <(frames) >"$build/both"
    [ "$(wc -l <"$build/both")" -ge 12 ] || fail "only $(wc -l <"$build/both") functions found in both"
    same "functions whose frames differ" "" "$(awk '$2 != $3' "$build/both")"
}

# name_of: in place of a symbol "robot language function"; of a function's two halves the one that is given the sines has _sc.
name_of='
function name_of(symbol,    part) {
    if (symbol ~ /idim_models::[a-z0-9_]*::[a-z_]*<float>/) {
        sub(/.*idim_models::/, "", symbol)
        sub(/<float>.*/, "", symbol)
        split(symbol, part, "::")
        return part[1] " cpp " part[2]
    }
    if (match(symbol, /_(regroup|inverse_dynamics|mass_matrix|forward_dynamics|regressor)(_sc)?_f$/)) {
        return substr(symbol, 1, RSTART - 1) " c " substr(symbol, RSTART + 1, RLENGTH - 3)
    }
    return ""
}'

# figures: lines "robot language function bytes instructions stack stack_seen": code size of both halves; instructions of the
# longest of the calls; the worst case of the chain of calls; the deepest stack that a call was seen to use.
figures() {
    {
        symbols -S "$elf" | awk '$3 ~ /[TtWw]/ { print "size", $2, $4 }' | arm-none-eabi-c++filt
        frames | awk '{ print "frame", $3, $1 }' | arm-none-eabi-c++filt
        grep '^took' "$printed"
    } | awk "$name_of"'
        function hexadecimal(digits,    i, value) {
            for (i = 1; i <= length(digits); ++i) {
                value = 16 * value + index("0123456789abcdef", substr(digits, i, 1)) - 1
            }
            return value
        }
        $1 == "took" { instructions[$2 " " $3 " " $4] = $6; seen[$2 " " $3 " " $4] = $8; next }
        {
            symbol = $0
            sub(/^[^ ]* [^ ]* /, "", symbol)
            name = name_of(symbol)
            whole = name
            sub(/_sc$/, "", whole)
            if ($1 == "size") {
                size[whole] += hexadecimal($2)
            } else if (name == whole) {
                worst[name] = $2
            }
        }
        END {
            for (name in instructions) {
                print name, size[name], instructions[name], worst[name], seen[name]
            }
        }' | sort
}

StackSeenStaysBelowTheWorstCase() {
    figures >"$build/figures"
    [ "$(wc -l <"$build/figures")" -eq 30 ] || { cat "$build/figures"; fail "expected 3 robots x 2 languages x 5 functions"; }
    # Four bytes are what paint_stack, itself a function, leaves unpainted.
    same "calls that used more stack than the worst case" "" "$(awk '$7 > $6 + 4' "$build/figures")"
}

Table() {
    figures >"$build/figures"
    echo "Cortex-M4F, single precision, $(arm-none-eabi-g++ -dumpversion), -O2. bytes: code, without sinf and cosf. instructions: of one call with"
    echo "its sines and cosines, the longest of 20 states (executed, not cycles). stack: worst case of the chain of calls, and seen."
    printf '%-10s %-4s %-17s %7s %13s %7s %6s\n' robot "" function bytes instructions stack seen
    awk '{ printf "%-10s %-4s %-17s %7d %13d %7d %6d\n", $1, $2, $3, $4, $5, $6, $7 }' "$build/figures"
    echo "The whole program, with sinf and cosf:"
    arm-none-eabi-size "$elf"
}

StaysWithinItsBudgets() {
    Table
    local over
    over=$(grep -v '^#' "$sources/budgets.txt" | awk 'NR == FNR { bytes[$1 $2 $3] = $4; instructions[$1 $2 $3] = $5; stack[$1 $2 $3] = $6; next }
        !(($1 $2 $3) in bytes) || $4 > bytes[$1 $2 $3] || $5 > instructions[$1 $2 $3] || $6 > stack[$1 $2 $3] {
            print "over its budget:", $0 }' - "$build/figures")
    same "budgets (budgets.txt)" "" "$over"
}

# Writes the budgets: a tenth above what is measured now.
SetBudgets() {
    figures >"$build/figures"
    {
        echo "# What each function may take at most on a Cortex-M4F: a tenth above what was measured on $(date +%Y-%m-%d) with gcc $(arm-none-eabi-g++ -dumpversion)."
        echo "# robot, language, function, bytes of code, instructions of one call, bytes of stack in the worst case"
        awk '{ printf "%s %s %s %d %d %d\n", $1, $2, $3, 1.1 * $4 + 1, 1.1 * $5 + 1, 1.1 * $6 + 1 }' "$build/figures"
    } >"$sources/budgets.txt"
}

"$1"
