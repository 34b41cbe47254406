#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""usage: completions.py PROGRAM BASH_FILE ZSH_FILE

Completions of jobs, options and choices for bash and zsh, from what --help says."""
import re
import sys

import job_help

BASH = '''# Generated from `knotwork --help`
_knotwork()
{{
  local current="${{COMP_WORDS[COMP_CWORD]}}" before="${{COMP_WORDS[COMP_CWORD - 1]}}" job="${{COMP_WORDS[1]}}" words=""
  if [ "$COMP_CWORD" = 1 ]; then
    COMPREPLY=($(compgen -W "{jobs} --help --version" -- "$current"))
    return
  fi
  case "$job $before" in
{choices}
  esac
  if [ -n "$words" ]; then
    COMPREPLY=($(compgen -W "$words" -- "$current"))
    return
  fi
  case "$job" in
{options}
  esac
  case "$current" in
    -*) COMPREPLY=($(compgen -W "$words" -- "$current")) ;;
    *) compopt -o filenames; COMPREPLY=($(compgen -f -- "$current")) ;;
  esac
}}
complete -F _knotwork knotwork
'''
ZSH = '''#compdef knotwork
# Generated from `knotwork --help`
_knotwork()
{{
  local -a jobs
  jobs=(
{jobs}
  )
  if (( CURRENT == 2 )); then
    _describe job jobs
    return
  fi
  case "$words[2]" in
{options}
    *) _files ;;
  esac
}}
_knotwork "$@"
'''


def choices_of(rest):
    found = re.search(r"\{([^}]*)\}", rest)
    return found[1].split(",") if found else ["0", "1"] if rest.startswith("[0|1]") else []


def described(name, text):
    """As _describe of zsh takes it."""
    return "    '" + name + ":" + text.replace(":", "\\:").replace("'", "'\\''") + "'"


def main(program, bash_file, zsh_file):
    names = job_help.jobs(program)
    choices, bash, zsh = [], [], []
    for name in sorted(names):
        options = job_help.ask(program, name).options()
        listed = [each for spellings, _, _ in options for each in spellings]
        bash.append(f'    {name}) words="{" ".join(listed)}" ;;')
        specified = []
        for spellings, rest, meaning in options:
            some = choices_of(rest)
            if some:
                choices.append(f'    "{name} {spellings[-1]}") words="{" ".join(some)}" ;;')
            follows = "" if not rest else ":value:(" + " ".join(some) + ")" if some else ":value:_files"
            for spelling in spellings:
                what = meaning.split("; ")[0][:100]
                specified.append("      " + "'" + spelling + "[" + re.sub(r"[\[\]':\\]", " ", what) + "]" + follows + "'")
        zsh.append(f"    {name}) _arguments \\\n" + " \\\n".join(specified) + " \\\n      '*:file:_files' ;;")
    with open(bash_file, "w", encoding="utf-8") as stream:
        stream.write(BASH.format(jobs=" ".join(sorted(names)), choices="\n".join(choices), options="\n".join(bash)))
    with open(zsh_file, "w", encoding="utf-8") as stream:
        stream.write(ZSH.format(jobs="\n".join(described(*each) for each in sorted(names.items())),
                                options="\n".join(zsh)))


if __name__ == "__main__":
    main(*sys.argv[1:])
