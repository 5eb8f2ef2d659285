# Shared by the tests of this folder. Each is called as: <test>.sh CLAIM, with SOURCE, BUILD and WORK (a folder of its own) in the
# environment, and fails by `fail`.
set -euo pipefail
export LC_ALL=C
unset IDIM_TEMPLATES PKG_CONFIG_PATH DESTDIR || true

tree=$WORK/tree # the installed tree, moved after it was installed
idim=$tree/bin/idim

fail() {
    echo "FAILED: $*" >&2
    exit 1
}

contains() { # FILE TEXT
    grep -qF -- "$2" "$1" || { cat "$1"; fail "no \"$2\" above"; }
}

same() { # WHAT BEFORE AFTER
    [ "$2" = "$3" ] || { diff <(echo "$2") <(echo "$3") || true; fail "$1"; }
}
