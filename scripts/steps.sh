# Sourced by the scripts that run in steps: `step NAME` ends the step before and starts one; `step_times` says
# how long each took, in seconds, and adds it to the file that VOYAGER_STEP_TIMES names.
step_names=() step_starts=()
step() {
  step_names+=("$1") step_starts+=("$SECONDS")
  printf '\n== %s (%d s)\n' "$1" "$SECONDS"
}
step_times() {
  printf '\nseconds by step\n'
  list_step_times | tee -a "${VOYAGER_STEP_TIMES:-/dev/null}"
}
list_step_times() {
  local i end
  for i in "${!step_names[@]}"; do
    end=${step_starts[i + 1]:-$SECONDS}
    printf '%6d  %s\n' $((end - step_starts[i])) "${step_names[i]}"
  done
  printf '%6d  in all\n' "$SECONDS"
}
