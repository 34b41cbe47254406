#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# usage: with-display.sh COMMAND [ARGUMENT...]
# Runs the command on a virtual X display with software rendering, so that pictures do not depend on the machine. A
# display that an outer call started is used again; the caller's own display never is. Listing tests needs none.
if [ -n "$KNOTWORK_DISPLAY" ]; then
  exec "$@"
fi
case "$2" in
  --gtest_list_tests*) exec "$@" ;;
esac
folder=$(mktemp -d) || exit 1
mkfifo "$folder/number" || exit 1
# -displayfd: the server picks a free number itself and reports it when it is ready
Xvfb -displayfd 3 -screen 0 1280x1024x24 -nolisten tcp -noreset 3> "$folder/number" 2> "$folder/log" < /dev/null > /dev/null &
server=$!
trap 'kill $server 2> /dev/null; wait $server 2> /dev/null; rm -rf "$folder"' EXIT
trap 'exit 130' INT
trap 'exit 143' TERM
number=$(head -n 1 "$folder/number")
if [ -z "$number" ]; then
  echo "with-display.sh: Xvfb did not start: $(tail -n 1 "$folder/log")" >&2
  exit 1
fi
export DISPLAY=":$number" KNOTWORK_DISPLAY=":$number" LIBGL_ALWAYS_SOFTWARE=1
export ASAN_OPTIONS="${ASAN_OPTIONS:+$ASAN_OPTIONS:}detect_leaks=0" # the drivers leak, not we
unset WAYLAND_DISPLAY XAUTHORITY
"$@"
