# Sourced by scripts/run and scripts/test: packages, compilation, BLAS. Silent when there is nothing to do.
# Defines root (top of the checkout), build (Meson's folder, SQUEAL_BUILD overrides), say, set_up.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=${SQUEAL_BUILD:-$root/build}

say() { printf 'squeal: %s\n' "$*" >&2; }

# quietly COMMAND...: shows its output only when it fails
quietly()
{
  local output
  output=$("$@" 2>&1) && return
  printf '%s\n' "$output" >&2
  say "failed: $*"
  return 1
}

# missing PACKAGES...: those that Debian's package database does not list as installed, on one line
missing()
{
  # shellcheck disable=SC2046,SC2005
  echo $(LC_ALL=C comm -23 <(printf '%s\n' "$@" | LC_ALL=C sort) \
    <(dpkg-query -W -f '${db:Status-Status} ${Package}\n' "$@" 2>/dev/null | sed -n 's/^installed //p' | LC_ALL=C sort))
}

# Installs the packages of packages.txt that are missing; of those marked ? the ones that this Debian has
install_packages()
{
  local wanted optional package
  command -v dpkg-query >/dev/null || return 0 # another system: Meson names what is missing
  wanted=$(sed 's/#.*//; /?/d' "$root/scripts/packages.txt")
  optional=$(sed -n 's/#.*//; s/?//p' "$root/scripts/packages.txt")
  # shellcheck disable=SC2086
  wanted=$(missing $wanted)
  # shellcheck disable=SC2086
  optional=$(missing $optional)
  if [ -n "$wanted$optional" ] && [ "$(id -u)" -ne 0 ] && ! command -v sudo >/dev/null; then
    [ -n "$wanted" ] || return 0
    say "no sudo; as root run: apt-get install $wanted"
    return 1
  fi
  [ -z "$wanted" ] || with_apt update || return
  for package in $optional; do
    [ "$(apt-cache policy "$package" 2>/dev/null | sed -n 's/^ *Candidate: //p' | grep -v none)" ] && wanted="$wanted $package"
  done
  [ -n "$wanted" ] || return 0
  say "installing Debian packages:" $wanted
  # shellcheck disable=SC2086
  with_apt install -y --no-install-recommends $wanted
}

# with_apt ARGUMENTS...: apt-get as root
with_apt()
{
  local privilege=()
  [ "$(id -u)" -eq 0 ] || privilege=(sudo)
  quietly "${privilege[@]}" env DEBIAN_FRONTEND=noninteractive apt-get "$@"
}

# compile TARGETS...: configures once, then compiles what changed
compile()
{
  if [ ! -f "$build/build.ninja" ]; then
    say "configuring $build"
    quietly meson setup "$build" "$root" || return
  fi
  ninja -C "$build" -n "$@" 2>/dev/null | grep -q 'no work to do' && return
  say "compiling"
  quietly ninja -C "$build" "$@"
}

# check_blas [PROGRAM]: warns when it loads the reference BLAS: a choice of the administrator, hence not changed here
check_blas()
{
  local blas
  blas=$(ldd "${1-$build/squeal}" 2>/dev/null | sed -n 's/.*libblas\.so[^ ]* => \([^ ]*\).*/\1/p')
  case $(readlink -f "$blas") in
    */blas/libblas.so*)
      say "$blas is the reference BLAS, several times slower;" \
        "see update-alternatives --display ${blas##*/}-$(uname -m)-linux-gnu"
      ;;
    *) choose_kernels "$blas" ;;
  esac
}

# The kernels of OpenBLAS for wide registers, in quotes: the list of the program
wide_kernels() { sed -n 's/^static const char \*const wide\[\] = {\(.*\)};$/\1/p' "$root/src/base/algebra/blas.c"; }

# choose_kernels BLAS: OpenBLAS has old kernels, two to three times slower, for a processor newer than itself. Exports
# OPENBLAS_CORETYPE for what this one can do, as `squeal -squeal_view` advises; what is set already stays
choose_kernels()
{
  local kernels flags wide
  [ -z "${OPENBLAS_CORETYPE-}" ] || return 0
  kernels=$(OPENBLAS_VERBOSE=2 LD_PRELOAD=$1 "$(type -P true)" 2>&1 | sed -n 's/^Core: //p')
  wide=$(wide_kernels)
  case ${wide,,} in *"\"${kernels,,}\""*) return 0 ;; esac
  [ -n "$kernels" ] || return 0
  flags=" $(sed -n 's/^flags[^:]*://p; /^flags/q' /proc/cpuinfo 2>/dev/null) "
  case $flags in
    *' avx512dq '*' avx512vl '*) export OPENBLAS_CORETYPE=SkylakeX ;;
    *' fma '*' avx2 '*) export OPENBLAS_CORETYPE=Haswell ;;
  esac
}

# set_up TARGETS...: everything that running these targets needs
set_up()
{
  install_packages && compile "$@" && check_blas
}
