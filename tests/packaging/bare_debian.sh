#!/usr/bin/env bash
# Installs the three packages in a bare Debian 12, where apt finds what they depend on, and uses them there.
# Usage: bare_debian.sh PACKAGES CACHE. CACHE keeps the bare system and the archives that apt fetched, so that the next run
# is quick. DEPTHGRID_DEBIAN_MIRROR: another mirror than debootstrap's own.
#
# All that is mounted is mounted in a namespace of this run, and the system that is installed into lies in memory: both are
# gone when the last process of the run is, even one that was killed.
set -euo pipefail
packages=$1 cache=$2
skip() {
  echo "skipped: $*"
  exit 0
}

if [[ -z ${BARE_DEBIAN_INSIDE:-} ]]; then
  ((EUID == 0)) || skip "only root may make a chroot"
  command -v debootstrap >/dev/null || skip "no debootstrap here; scripts/install-packages package installs it"
  unshare --mount --pid --fork true 2>/dev/null || skip "this machine allows no mounts of one's own (unshare --mount)"
  (($(awk '/^MemAvailable:/ {print $2}' /proc/meminfo) > 3000000)) || skip "less than 3 GB of memory are free"
  mkdir -p "$cache/archives/partial"
  exec 9>"$cache/lock"
  flock 9
  rm -rf "$cache/unfinished"
  BARE_DEBIAN_INSIDE=yes exec unshare --mount --pid --fork --kill-child --mount-proc "$0" "$packages" "$cache"
fi

say() { printf '== %s (%s s)\n' "$*" "$SECONDS"; }
fail() {
  echo "bare_debian: $*" >&2
  exit 1
}

if [[ ! -d $cache/base ]]; then
  mirror=(${DEPTHGRID_DEBIAN_MIRROR:+"$DEPTHGRID_DEBIAN_MIRROR"})
  debootstrap --variant=minbase --print-debs bookworm "$cache/unfinished" "${mirror[@]}" >/dev/null 2>"$cache/mirror.log" ||
    skip "no Debian mirror is reached: $(tail -n 1 "$cache/mirror.log")"
  rm -rf "$cache/unfinished"
  say "making the bare system"
  debootstrap --variant=minbase bookworm "$cache/unfinished" "${mirror[@]}" >"$cache/debootstrap.log" 2>&1 ||
    fail "debootstrap failed:"$'\n'"$(tail -n 20 "$cache/debootstrap.log")"
  echo force-unsafe-io >"$cache/unfinished/etc/dpkg/dpkg.cfg.d/quick"
  printf '%s\n' 'APT::Install-Recommends "false";' 'Acquire::Languages "none";' >"$cache/unfinished/etc/apt/apt.conf.d/bare"
  rm -rf "$cache/unfinished"/var/cache/apt/archives/*.deb
  mv "$cache/unfinished" "$cache/base"
fi

root=$cache/root
mkdir -p "$root"
mount -t tmpfs -o size=3g,mode=755 depthgrid "$root"
cp -a "$cache/base/." "$root"
cp /etc/resolv.conf "$root/etc/resolv.conf"
mount --bind "$cache/archives" "$root/var/cache/apt/archives"
mount -t proc proc "$root/proc"
mkdir "$root/packages"
cp "$packages"/*.deb "$root/packages"

# A plain environment, but for the way to the mirror.
inside() {
  env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 DEBIAN_FRONTEND=noninteractive MANWIDTH=80 \
    ${http_proxy:+http_proxy="$http_proxy"} chroot "$root" bash -euc "$1" </dev/null
}
# apt_install PACKAGE... with what they depend on; the list of packages is fetched anew if it is too old.
apt_install() {
  inside "cd /packages && apt-get -qq -y install $*" >"$cache/apt.log" 2>&1 ||
    inside "cd /packages && apt-get -qq update && apt-get -qq autoclean && apt-get -qq -y install $*" >"$cache/apt.log" 2>&1 ||
    fail "apt-get install $*:"$'\n'"$(tail -n 20 "$cache/apt.log")"
}
# expect REGEX COMMAND
expect() {
  local output
  output=$(inside "$2" 2>&1) || fail "'$2' failed:"$'\n'"$output"
  grep -qE -- "$1" <<<"$output" || fail "'$2' prints nothing like '$1':"$'\n'"$output"
  say "ok: $2"
}

say "installing the command"
! inside 'command -v depthgrid || command -v g++ || command -v man' || fail "the system is not bare"
apt_install './depthgrid_*.deb'
expect '^Usage: depthgrid ' 'depthgrid --help'
expect '^depthgrid [0-9.]+$' 'depthgrid --version'
expect 'No answer is above the true distance' 'depthgrid demo --picture /root/demo.png'
expect '^89504e470d0a1a0a' 'head -c 8 /root/demo.png | od -An -tx1 | tr -d " \n"'
apt_install man-db
for page in $(inside 'dpkg -L depthgrid' | sed -n 's|^/usr/share/man/man1/\(.*\)\.1\.gz$|\1|p'); do
  expect "^/usr/share/man/man1/$page\\.1\\.gz$" "man -w $page"
done
expect 'depthgrid-demo - ' 'man depthgrid-demo'
expect "^depthgrid \\(1\\) " 'whatis depthgrid'

say "installing what a program is built with"
apt_install './libdepthgrid-dev_*.deb' './depthgrid-doc_*.deb' g++ cmake make pkg-config
expect '^# depthgrid$' 'cat /usr/share/doc/depthgrid/README.md'
expect '^wrist: 0\.(19[0-9]*|2) m, measured$' 'cp -r /usr/share/doc/libdepthgrid-dev/examples/consumer /root &&
  cd /root/consumer && cmake -S . -B build -DCMAKE_BUILD_TYPE=Release >/dev/null && cmake --build build >/dev/null && build/consumer'
expect '^0\.[0-9]+ m  unmeasured, known to 0\.340 m$' \
  'g++ -std=c++20 -O1 /usr/share/doc/libdepthgrid-dev/examples/quickstart.cpp -o /root/quickstart \
    $(pkg-config --cflags --libs depthgrid_search) && /root/quickstart'

say "removing them"
inside 'apt-get -qq -y purge depthgrid libdepthgrid-dev depthgrid-doc' >"$cache/apt.log" 2>&1 || fail "$(cat "$cache/apt.log")"
left=$(inside 'find / -xdev -name "*depthgrid*" -not -path "/proc/*" -not -path "/packages/*" -not -path "/root/*" -not -path "/var/cache/man/*"')
[[ -z $left ]] || fail "left behind after removal: $left"
say "done"
