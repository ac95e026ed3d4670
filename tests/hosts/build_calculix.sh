#!/bin/sh
# Builds CalculiX with support for external behaviours, from Debian's source package, once.
# Usage: build_calculix.sh DIRECTORY    makes DIRECTORY/ccx
# Exit status 77 where that cannot be done here.
set -eu

directory=$1
[ -x "$directory/ccx" ] && exit 0
if ! command -v apt-get >/dev/null; then
    echo "CalculiX is left out: its source package comes from Debian, and this is no Debian" >&2
    exit 77
fi
as_root=
[ "$(id -u)" -eq 0 ] || as_root=sudo

# the source packages of the configured archives, without touching the system's own lists
mkdir -p "$directory/apt/parts" "$directory/apt/lists/partial" "$directory/source"
directory=$(cd "$directory" && pwd)
for list in /etc/apt/sources.list /etc/apt/sources.list.d/*; do
    [ -f "$list" ] || continue
    case $list in
    *.sources) sed 's/^Types:.*/Types: deb-src/' "$list" ;;
    *.list) sed -n 's/^deb /deb-src /p' "$list" ;;
    esac >"$directory/apt/parts/$(basename "$list")"
done
apt() {
    apt-get -q -o Dir::Etc::SourceList=/dev/null -o Dir::Etc::SourceParts="$directory/apt/parts" \
        -o Dir::State::Lists="$directory/apt/lists" "$@"
}
cd "$directory/source"
apt update
if ! apt source --download-only calculix-ccx; then
    echo "CalculiX is left out: its source package cannot be had here" >&2
    exit 77
fi
$as_root env DEBIAN_FRONTEND=noninteractive apt-get -qy -o DPkg::Lock::Timeout=600 install --no-install-recommends \
    bzip2 xz-utils patch libspooles-dev libarpack2-dev liblapack-dev

tar xf calculix-ccx_*.orig.tar.*
cd CalculiX
tar xf ../calculix-ccx_*.debian.tar.*
while read -r patch; do
    patch -p1 -s <"debian/patches/$patch"
done <debian/patches/series
cd ccx_*/src
program=$(basename "$(dirname "$PWD")")
# without optimisation: its models here are small, and its sources many
make -j"$(nproc)" "$program" \
    CFLAGS='-w -O0 -I/usr/include/spooles -DARCH="Linux" -DSPOOLES -DARPACK -DMATRIXSTORAGE -DUSE_MT=1 -DCALCULIX_EXTERNAL_BEHAVIOURS_SUPPORT' \
    FFLAGS='-w -O0 -fallow-argument-mismatch' LDFLAGS='-ldl'
cp "$program" "$directory/ccx"
rm -rf "$directory/source"
