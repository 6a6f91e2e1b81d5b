# Most stack below a call, in bytes: frames as the compiler gives them (section .stack_sizes), calls as they stand in the image.
#
# Input: the bytes of that section in decimal, one a line, the line "code", then the disassembly. `root` is part of a function's name.
function hex(text,   value, i) {
    value = 0
    for (i = 1; i <= length(text); i++) value = 16 * value + index("0123456789abcdef", substr(text, i, 1)) - 1
    return value
}
function depth(f,   i, n, list, deepest, below) {
    if (f in known) return known[f]
    if (f in open) { print "recursion at " name[f] > "/dev/stderr"; failed = 1; return 0 }
    if (f in unknown) { print "a call that is not known before it is made, in " name[f] > "/dev/stderr"; failed = 1 }
    open[f]
    deepest = 0
    n = split(calls[f], list, " ")
    for (i = 1; i <= n; i++) {
        below = depth(list[i])
        if (below > deepest) deepest = below
    }
    delete open[f]
    return known[f] = frame[f] + deepest
}
!code && $1 == "code" { code = 1; next }
# Four bytes of address, then the size, seven bits a byte, the last byte below 128.
!code && place < 4 { address += $1 * 256 ^ place++; next }
!code {
    size += ($1 % 128) * 128 ^ (place++ - 4)
    if ($1 < 128) { frame[address - address % 2] = size; place = address = size = 0 }
    next
}
/^[0-9a-f]+ <.*>:$/ { here = hex($1); name[here] = $2; if (index($2, root)) start = here; next }
$2 ~ /^(b|cb)/ && match($0, /[0-9a-f]+ <[^+>]*>$/) {
    target = hex(substr($0, RSTART, index(substr($0, RSTART), " ") - 1))
    if (target != here || $2 == "bl") calls[here] = calls[here] " " target
}
$2 == "blx" || ($2 == "bx" && $3 != "lr") { unknown[here] }
END { print depth(start); exit failed }
