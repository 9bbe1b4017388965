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

# Installs the packages of packages.txt that Debian's package database does not list as installed
install_packages()
{
  local wanted missing privilege=()
  command -v dpkg-query >/dev/null || return 0 # another system: Meson names what is missing
  wanted=$(sed 's/#.*//' "$root/scripts/packages.txt")
  # shellcheck disable=SC2086
  missing=$(LC_ALL=C comm -23 <(printf '%s\n' $wanted | LC_ALL=C sort) \
    <(dpkg-query -W -f '${db:Status-Status} ${Package}\n' $wanted 2>/dev/null | sed -n 's/^installed //p' |
      LC_ALL=C sort))
  [ -n "$missing" ] || return 0
  missing=$(echo $missing)
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || { say "no sudo; as root run: apt-get install $missing"; return 1; }
    privilege=(sudo)
  fi
  say "installing Debian packages: $missing"
  quietly "${privilege[@]}" apt-get update || return
  # shellcheck disable=SC2086
  quietly "${privilege[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends $missing
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

# Warns when the program loads the reference BLAS: a choice of the administrator, hence not changed here
check_blas()
{
  local blas
  blas=$(ldd "$build/squeal" | sed -n 's/.*libblas\.so[^ ]* => \([^ ]*\).*/\1/p')
  case $(readlink -f "$blas") in
    */blas/libblas.so*)
      say "$blas is the reference BLAS, several times slower;" \
        "see update-alternatives --display ${blas##*/}-$(uname -m)-linux-gnu"
      ;;
  esac
}

# set_up TARGETS...: everything that running these targets needs
set_up()
{
  install_packages && compile "$@" && check_blas
}
