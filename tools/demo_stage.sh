# Sourced by what plays the demo stage for long. Whoever calls it ends $screen and $rigs.

# A display of this SIZE, without a monitor; sets $screen and DISPLAY.
start_screen() { # size, folder of its log
  Xvfb -displayfd 3 -nolisten tcp -screen 0 "$1x24" 3>"$2/display" 2>"$2/screen.log" &
  screen=$!
  until grep -qs '[0-9]$' "$2/display"; do sleep 0.1; kill -0 $screen; done
  DISPLAY=:$(cat "$2/display")
  export DISPLAY
}

# The demo's four rigs, in FOLDER/demo, which draw the stage's loop first; sets $rigs.
start_rigs() { # folder, folder of its log
  build/release/bin/vantage demo --folder "$1" --rigs-only >"$2/ready" 2>"$2/rigs.log" &
  rigs=$!
  until grep -q '^ready:' "$2/ready" && [ "$(grep -ls 'publishing on' "$1"/demo/rig?.log | wc -l)" -eq 4 ]; do
    sleep 0.2
    kill -0 $rigs
  done
}

# A line each of the seconds, name, process, memory in KiB, threads and open files.
sample() { # seconds, process...
  local process kib threads
  for process in "${@:2}"; do
    read -r kib threads < <(awk '/VmRSS/ {kib = $2} /Threads/ && kib {print kib, $2}' "/proc/$process/status" 2>/dev/null) || continue
    echo "$1 $(cat "/proc/$process/comm") $process $kib $threads $(ls "/proc/$process/fd" | wc -l)" || true
  done 2>/dev/null
}
