# SPDX-License-Identifier: Apache-2.0
# Completion of `sandwall` for bash. Options and names come from the program itself, so they are always those of its version.
_sandwall() {
    local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} command=${COMP_WORDS[1]} names= files=yes
    # bash takes the colon of script:NAME as a word of its own, and replaces only what follows it.
    if [[ $word == : || $before == : ]] && (( COMP_CWORD > 3 )); then
        local kind=$((COMP_CWORD - 2))
        [[ $word == : ]] && kind=$((COMP_CWORD - 1)) word=
        [[ ${COMP_WORDS[kind - 1]} == --device && ${COMP_WORDS[kind]} == script ]] && names=$(sandwall list strokes 2>/dev/null)
        mapfile -t COMPREPLY < <(compgen -W "$names" -- "$word"; compgen -f -- "$word")
        return 0
    fi
    COMPREPLY=()
    if [[ $COMP_CWORD -eq 1 ]]; then
        names=$(sandwall complete 2>/dev/null) files=
    elif [[ $before == --wall || ($command == @(check|doctor) && $COMP_CWORD -eq 2) ]]; then
        names=$(sandwall list walls 2>/dev/null)
    elif [[ $command == ctl && $COMP_CWORD -eq 3 ]]; then
        names=$(sandwall complete ctl VERB 2>/dev/null) files=
    elif [[ $before == --scene || ($command == try && $COMP_CWORD -eq 2 && $word != -*) ]]; then
        names=$(sandwall list scenes 2>/dev/null)
    elif [[ $before == --device ]]; then
        names="$(sandwall list strokes 2>/dev/null | sed 's/^/script:/') $(sandwall complete run --device 2>/dev/null)" files=
    elif [[ $word == -* ]]; then
        names=$(sandwall complete "$command" 2>/dev/null) files=
    elif [[ $before == --* ]]; then
        names=$(sandwall complete "$command" "$before" 2>/dev/null)
        [[ -z $names ]] || files=
    fi
    mapfile -t COMPREPLY < <(compgen -W "$names" -- "$word"; [[ -z $files ]] || compgen -f -- "$word")
}
complete -o filenames -F _sandwall sandwall
