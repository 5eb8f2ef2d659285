#!/usr/bin/env bash
# The Debian packages, looked into without being installed.
. "$(dirname "$0")/support.sh"

architecture=$(dpkg --print-architecture)
packages=$WORK/packages
command=$packages/idim_${VERSION}_$architecture.deb
development=$packages/libidim-dev_${VERSION}_$architecture.deb

make_packages() { # FOLDER
    rm -rf "$1"
    (cd "$BUILD" && SOURCE_DATE_EPOCH=1700000000 cpack -G DEB -B "$1") >"$WORK/cpack.log" 2>&1 || { cat "$WORK/cpack.log"; fail "cpack"; }
}

AreMade() {
    mkdir -p "$WORK"
    make_packages "$packages"
    [ -f "$command" ] && [ -f "$development" ] || { ls "$packages"; fail "expected $command and $development"; }
}

listed() { dpkg-deb --fsys-tarfile "$1" | tar -t | grep -v '/$' | sort; }

from() { # FOLDER PLACE: files of a folder of the sources, as paths in the package
    (cd "$SOURCE/$1" && find . -type f -printf "./usr/$2/%P\n")
}

HoldWhatTheSourcesHave() {
    local expected
    expected=$({
        from templates share/idim/templates
        from robots share/idim/robots
        echo ./usr/bin/idim
        printf './usr/include/idim/%s\n' model_interface.h effect_interface.h law_interface.h law_adapter.hpp
        printf './usr/share/cmake/idim/%s\n' idim-config.cmake idim-config-version.cmake idim_generate.cmake
        printf './usr/share/doc/idim/%s\n' README.md changelog.gz copyright
        echo ./usr/share/man/man1/idim.1.gz
    } | sort)
    same "$command" "$expected" "$(listed "$command")"
    expected=$({
        from runtime/include include | grep -vE '/(model_interface|effect_interface|law_interface)[.]h$|/law_adapter[.]hpp$'
        printf './usr/lib/%s\n' libidim_runtime.a pkgconfig/idim.pc cmake/idim/idim-runtime-targets.cmake \
            cmake/idim/idim-runtime-targets-release.cmake
        printf './usr/share/doc/libidim-dev/%s\n' changelog.gz copyright
    } | sort)
    same "$development" "$expected" "$(listed "$development")"
}

SayWhatTheyNeed() {
    local needed
    needed=$(dpkg-deb -f "$command" Depends)
    for library in libc6 libyaml-cpp libmd liburdfdom; do
        grep -q "\b$library" <<<"$needed" || fail "$library is missing in: $needed"
    done
    same "Depends of libidim-dev" "idim (= $VERSION), libeigen3-dev, libfmt-dev, zlib1g-dev, libmd-dev, libnlopt-dev" \
        "$(dpkg-deb -f "$development" Depends)"
    [ "$(dpkg-deb -f "$command" Installed-Size)" -lt 10000 ] || fail "idim takes more than 10 MB"
}

unpack() { # FOLDER
    rm -rf "$1"
    dpkg-deb -x "$command" "$1"
    dpkg-deb -x "$development" "$1"
}

NameNoFolderTheyWereBuiltIn() {
    unpack "$WORK/searched"
    same "files that name the build" "" "$(grep -rlF -e "$SOURCE" -e "$BUILD" "$WORK/searched" || true)"
}

AreOwnedByRootAndReadByAll() {
    local wrong
    wrong=$(for package in "$command" "$development"; do dpkg-deb -c "$package"; done |
        awk '$2 != "root/root" || !($1 ~ /^drwxr-xr-x|^-rw-r--r--/ || ($1 == "-rwxr-xr-x" && $6 == "./usr/bin/idim"))')
    same "owners and rights" "" "$wrong"
}

CommandRunsFromThePackage() {
    unpack "$WORK/unpacked"
    local usr=$WORK/unpacked/usr
    same "version" "$VERSION" "$("$usr/bin/idim" --version)"
    env -i "$usr/bin/idim" generate "$usr/share/idim/robots/emps/emps.yaml" -o "$WORK/package_emps" >/dev/null
    diff -r "$WORK/package_emps" "$SOURCE/generated/emps" || fail "another model than in the sources"
}

AreTheSameWhenMadeAgain() {
    make_packages "$WORK/packages_again"
    for package in "$command" "$development"; do
        cmp "$package" "$WORK/packages_again/$(basename "$package")" || fail "not the same bytes"
    done
}

"$1"
