# Completion of squeal's command line in bash. All names and values come from the program itself: from squeal -help_json, with
# the options files that stand on the line, so that the names of their parts and contacts are completed too. An answer is
# kept until the program or one of those files changes. Bash reads this file where the package bash-completion is
# installed; else: source it.

# Options, one a line: name, tab, kind of the value, and the words of a choice or the list to choose from
_squeal_read()
{
  OPENBLAS_NUM_THREADS=1 OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_ess_singleton_isolated=1 \
    "$@" -help_json 2>/dev/null </dev/null | awk '
    function member(name, ends) { # of the object of an option, which has a line
      return match($0, "\"" name "\": " ends) ? substr($0, RSTART + length(name) + 5, RLENGTH - length(name) - 6) : ""
    }
    /^  \{"name"/ {
      kind = "any"; words = member("choices", "\\[[^]]*\\]"); gsub(/[",]/, "", words)
      if (words != "") kind = "words " words
      else if (member("type", "\"[^\"]*\"") == "logical") kind = "words true false"
      else if (member("path", "\"[^\"]*\"") != "") kind = member("path", "\"[^\"]*\"")
      print "-" member("name", "\"[^\"]*\"") "\t" kind
    }'
}

# Sets _squeal_options for the program and the options files of the line
_squeal_options_of()
{
  local program=$1 i file key stamp
  local -a files=()
  for ((i = 1; i < ${#COMP_WORDS[@]} - 1; i++)); do
    [ "${COMP_WORDS[i]}" = -options_file ] || continue
    file=${COMP_WORDS[i + 1]}
    file=${file#[\'\"]}
    file=${file%[\'\"]}
    file=${file/#\~\//$HOME/}
    [ -f "$file" ] && files+=(-options_file "$file")
  done
  stamp=$(stat -L -c '%n %Y %i' -- "$(type -P -- "$program")" "${files[@]#-options_file}" 2>/dev/null)
  key="$PWD $stamp"
  [ "$key" = "${_squeal_key-}" ] && return
  _squeal_options=$(_squeal_read "$program" "${files[@]}")
  [ -n "$_squeal_options" ] || _squeal_options=$(_squeal_read "$program")
  _squeal_key=$key
}

# Completes a value of a kind
_squeal_value()
{
  local word=$2
  case $1 in
    words\ *) mapfile -t COMPREPLY < <(compgen -W "${1#words }" -- "$word") ;;
    folder)
      compopt -o filenames 2>/dev/null
      mapfile -t COMPREPLY < <(compgen -d -- "$word")
      ;;
    file)
      compopt -o filenames 2>/dev/null
      mapfile -t COMPREPLY < <(compgen -f -- "$word")
      ;;
    scene)
      compopt -o filenames 2>/dev/null
      mapfile -t COMPREPLY < <(compgen -f -X '!*.yaml' -- "$word"; compgen -f -X '!*.yml' -- "$word"; compgen -d -- "$word")
      ;;
  esac
}

_squeal()
{
  local program=${COMP_WORDS[0]} word=${COMP_WORDS[COMP_CWORD]} before='' kind
  COMPREPLY=()
  program=${program/#\~\//$HOME/}
  type -P -- "$program" >/dev/null || return
  [ "$COMP_CWORD" -gt 1 ] && before=${COMP_WORDS[COMP_CWORD - 1]}
  _squeal_options_of "$program"
  case $before in
    -options_file) kind=scene ;;
    -*) kind=$(awk -F '\t' -v name="$before" '$1 == name { print $2; exit }' <<<"$_squeal_options") ;;
    *) kind= ;;
  esac
  if [ -n "$kind" ] && [[ $word != -* ]]; then
    _squeal_value "$kind" "$word"
    [ "${#COMPREPLY[@]}" -gt 0 ] || [ "$kind" != any ] || compopt -o default 2>/dev/null
    return
  fi
  mapfile -t COMPREPLY < <(compgen -W "-options_file -help -help_all -help_json -h -version -log_view
    $(cut -f 1 <<<"$_squeal_options")" -- "${word:--}")
}

complete -F _squeal squeal
