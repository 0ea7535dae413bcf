#!/usr/bin/env bash
# What scripts/check_abi.sh lets pass, and what it refuses: check_abi_test.sh FOLDER, which is made anew for a copy
# of what the script reads. Fields that change their type but not their place are seen by nothing else here.
set -euo pipefail
cd "$(dirname "$0")/../.."
source=$PWD
copy=$1

make_copy() {
  rm -rf "$copy"
  mkdir -p "$copy/scripts" "$copy/plugin" "$copy/tests/abi"
  cp "$source/scripts/check_abi.sh" "$copy/scripts"
  cp -r "$source/plugin/include" "$copy/plugin"
  cp -r "$source"/tests/abi/{header_1.0,recorded,exports.txt,layout.txt} "$copy/tests/abi"
}

# A check that is left out passes nothing: without libabigail the script fails and says what brings it.
make_copy
mkdir "$copy/bin"
for program in bash dirname sha256sum; do ln -s "$(command -v $program)" "$copy/bin"; done
! PATH=$copy/bin "$copy/scripts/check_abi.sh" >"$copy/output" 2>&1 && grep -q 'scripts/setup.sh checks' "$copy/output" ||
  { cat "$copy/output"; echo "without abidiff: found no refusal that names scripts/setup.sh checks" >&2; exit 1; }

command -v abidiff >/dev/null && command -v abidw >/dev/null ||
  { echo "skipped: abidiff is not here, install abigail-tools"; exit 77; }

# check EXPECTED_EXIT_CODE HEADER SED_SCRIPT: of the headers with this change.
check() {
  local code=0
  make_copy
  sed -i "$3" "$copy/plugin/include/voyager/$2"
  ! cmp -s "$copy/plugin/include/voyager/$2" "$source/plugin/include/voyager/$2" ||
    { echo "$2, $3: found no such line to change" >&2; exit 1; }
  "$copy/scripts/check_abi.sh" >"$copy/output" 2>&1 || code=$?
  [ "$code" = "$1" ] || { cat "$copy/output"; echo "$2, $3: found exit code $code, expected $1" >&2; exit 1; }
}

check 1 voyager.h 's/^  float opacity;/  int32_t opacity;/'
check 1 voyager.h '/VoyTimeBudgetState timeBudgetState;/,/} VoyFrameStats;/s/^  double tau;/  float tau;/'
check 1 voyager.h 's/VOY_ERROR_TIMEOUT = -17/VOY_ERROR_TIMEOUT = -18/'
check 0 voyager.h 's/^  VOY_ERROR_TIMEOUT = -17,/&\n  VOY_ERROR_LATER = -18,/'
check 0 voyager_experiment.h '/^typedef struct VoyExperiment {/,/^} VoyExperiment;/s/^  uint32_t reserved/  float reserved/'
