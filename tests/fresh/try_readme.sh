#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Follows the README on a Debian 12 that has nothing: a tree made by debootstrap, in it a new user who
# may use sudo, and the commands of the sections "Try it" and "In pvbatch", word for word. ./test.sh is
# left out: it is what runs everywhere else. Not part of ctest: it takes a gigabyte from Debian's
# servers, and root's rights.
# usage: try_readme.sh FOLDER [MIRROR]
#   FOLDER  where the tree is made, or is from an earlier run; it is kept
#   MIRROR  of Debian's packages; http://deb.debian.org/debian if left out
set -euo pipefail

[ $# -ge 1 ] && [ $# -le 2 ] || { sed -n 3,10p "$0"; exit 2; }
[ "$(id -u)" -eq 0 ] || { echo "error: debootstrap and chroot need root" >&2; exit 1; }
command -v debootstrap >/dev/null || { echo "error: apt-get install debootstrap" >&2; exit 1; }
project=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
mkdir -p "$1"
tree=$(cd "$1" && pwd)
mirror=${2:-http://deb.debian.org/debian}
user=scientist
home=/home/$user/dsm-ray-tracer

unmount() {
  for place in dev/shm dev/pts dev proc; do
    if mountpoint -q "$tree/$place"; then umount "$tree/$place"; fi
  done
}
trap unmount EXIT

if [ ! -x "$tree/usr/bin/sudo" ]; then
  debootstrap --variant=minbase --include=sudo,ca-certificates bookworm "$tree" "$mirror"
fi
cp /etc/resolv.conf "$tree/etc/resolv.conf"
printf '127.0.0.1 localhost %s\n' "$(hostname)" >"$tree/etc/hosts"
mount -t proc proc "$tree/proc"
mount --bind /dev "$tree/dev"
mount --bind /dev/pts "$tree/dev/pts"
mount -t tmpfs tmpfs "$tree/dev/shm"

chroot "$tree" id -u $user >/dev/null 2>&1 || chroot "$tree" useradd --create-home --shell /bin/bash $user
printf '%s ALL=(ALL) NOPASSWD: ALL\n' $user >"$tree/etc/sudoers.d/$user"
rm -rf "${tree:?}$home"
mkdir -p "$tree$home"
git -C "$project" archive HEAD | tar -x -C "$tree$home"
chroot "$tree" chown -R $user: "$home"

# What a section of the README shows: its indented commands, and its Python.
section() { awk -v title="## $1" '$0 == title { inside = 1; next } /^## / { inside = 0 } inside' "$project/README.md"; }
section "Try it" | sed -n 's/^    \(\.\/demo.sh\)  *#.*$/\1/p' >"$tree$home/commands.sh"
section "In pvbatch" | sed -n '/^```python$/,/^```$/{/^```/d;p}' >"$tree$home/script.py"
section "In pvbatch" | sed -n 's/^    //p' | grep -F 'pvbatch script.py' >>"$tree$home/commands.sh"
[ "$(wc -l <"$tree$home/commands.sh")" -eq 2 ] ||
  { echo "error: the README does not show the two commands that are expected" >&2; exit 1; }
echo "The README says:"
cat "$tree$home/commands.sh"

chroot "$tree" su - $user -c "cd $home && set -e && . ./commands.sh" </dev/null
for picture in demo.png picture.png; do
  size=$(stat -c %s "$tree$home/$picture")
  kind=$(head -c 8 "$tree$home/$picture" | od -An -tx1 | tr -d ' \n')
  [ "$kind" = 89504e470d0a1a0a ] && [ "$size" -gt 20000 ] ||
    { echo "error: $picture shows nothing ($size bytes)" >&2; exit 1; }
  echo "ok: $picture was made, $size bytes"
done
