# Sourced by the other scripts: strict mode, the repository root, messages.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

say() { printf '== %s\n' "$*"; }
die() {
  printf '%s: %s\n' "$(basename "$0")" "$*" >&2
  exit 1
}

# Parallel jobs: one a core, and at least 1.5 GB of memory each, which an Eigen-heavy file may take.
job_count() {
  local cores memory_kb by_memory
  cores=$(nproc)
  memory_kb=$(awk '/^MemAvailable:/ {print $2}' /proc/meminfo)
  by_memory=$((memory_kb / 1500000))
  ((by_memory < 1)) && by_memory=1
  echo $((cores < by_memory ? cores : by_memory))
}

# Warnings are errors in CI and nowhere else.
warnings_as_errors() { [[ ${CI:-} == true ]] && echo ON || echo OFF; }

# configure_preset PRESET; further cmake options in the array configure_options.
configure_options=()
configure_preset() {
  say "configure $1"
  cmake --preset "$1" -DDEPTHGRID_WARNINGS_AS_ERRORS="$(warnings_as_errors)" "${configure_options[@]}"
}

# build_targets PRESET [TARGET...] builds everything, or these.
build_targets() {
  local preset=$1
  shift
  say "build $preset${*:+: $*}"
  cmake --build --preset "$preset" --parallel "$(job_count)" ${1:+--target "$@"}
}

# build_preset PRESET [TARGET...] configures and builds.
build_preset() {
  configure_preset "$1"
  build_targets "$@"
}
