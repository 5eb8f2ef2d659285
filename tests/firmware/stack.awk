# Stack of every function of a Cortex-M4F program, from `objdump -d --no-show-raw-insn`: lines "symbol frame worst", in bytes. The
# frame is all that a function takes from the stack pointer, worst adds the deepest chain of calls. A call whose target is not
# written down (blx) counts as nothing and marks the line with "indirect"; a frame of variable size ends the run.
function registers(list, width,    part, n, i, ends, count) { # "{r4, r5, d8-d15}": bytes of so many registers
    gsub(/[{} ]/, "", list)
    n = split(list, part, ",")
    for (i = 1; i <= n; ++i) {
        count += split(part[i], ends, "-") == 2 ? substr(ends[2], 2) - substr(ends[1], 2) + 1 : 1
        width = part[i] ~ /^d/ ? 8 : 4
    }
    return count * width
}

function worst(name, depth,    i, n, callee, deepest, one) {
    if (depth > 50) {
        print "recursion at " name > "/dev/stderr"
        exit 1
    }
    n = split(calls[name], callee, " ")
    for (i = 1; i <= n; ++i) {
        one = worst(callee[i], depth + 1)
        deepest = one > deepest ? one : deepest
        indirect[name] = indirect[name] || indirect[callee[i]]
    }
    return frame[name] + deepest
}

/^[0-9a-f]+ <.*>:$/ {
    name = substr($2, 2, length($2) - 3)
    frame[name] += 0
    next
}

$2 ~ /^v?push$/ || ($2 ~ /^v?stmdb/ && $3 == "sp!,") {
    list = $0
    sub(/^[^{]*/, "", list)
    frame[name] += registers(list)
}

$2 ~ /^sub(s|w)?(\.w)?$/ && $3 == "sp," {
    if ($0 !~ /#[0-9]+/) {
        print "frame of variable size in " name > "/dev/stderr"
        exit 1
    }
    match($0, /#[0-9]+/)
    frame[name] += substr($0, RSTART + 1, RLENGTH - 1)
}

$2 ~ /^v?strd?(\.w)?$/ && /\[sp, #-[0-9]+\]!/ {
    match($0, /#-[0-9]+/)
    frame[name] += substr($0, RSTART + 2, RLENGTH - 2)
}

$2 == "blx" { indirect[name] = 1 }

# Calls, and jumps to the beginning of another function, which take the place of a call in the end.
$2 ~ /^(bl|b|b\.w|b\.n)$/ && $4 ~ /^<[^+]*>$/ {
    callee = substr($4, 2, length($4) - 2)
    if (callee != name && !seen[name, callee]++) {
        calls[name] = calls[name] " " callee
    }
}

END {
    for (name in frame) {
        deepest = worst(name, 0)
        print name, frame[name], deepest, indirect[name] ? "indirect" : ""
    }
}
