# Completion of the command kreisel in bash. Options are those of the program's --help.

_kreisel() {
  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]}
  local -a words
  COMPREPLY=()
  if ((COMP_CWORD == 1)); then
    mapfile -t COMPREPLY < <(compgen -W 'simulate analyze ensemble deviation --help --version' -- "$word")
    return
  fi
  case $before in
    --method) words=(auto verner98 gauss16 radau13 splitting taylor) ;;
    --plot) mapfile -t COMPREPLY < <(compgen -d -- "$word") && return ;;
    --csv | --sites | --state-space) mapfile -t COMPREPLY < <(compgen -f -- "$word") && return ;;
  esac
  if [[ $word == -* ]]; then
    mapfile -t words < <("$1" "${COMP_WORDS[1]}" --help 2>/dev/null | grep -o '^ *\(-h,\)\?--[a-z-]*' | sed 's/.*\(--\)/\1/')
  fi
  if ((${#words[@]} > 0)); then
    mapfile -t COMPREPLY < <(compgen -W "${words[*]}" -- "$word")
  else
    mapfile -t COMPREPLY < <(compgen -f -X '!*.toml' -- "$word"; compgen -d -- "$word")
  fi
}
complete -o filenames -F _kreisel kreisel
