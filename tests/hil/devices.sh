#!/usr/bin/env bash
# The device tests in the virtual machine: real drivers, and the very programs that were built.
#   devices.sh WORK TEST_PROGRAM
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
work=$1 program=$2
"$here/prepare.sh" "$work"
exec "$here/boot.sh" "$work" devices "HIL_TEST=$program" "HIL_RULES=$(realpath "$here/../../udev")" "GTEST_FILTER=${GTEST_FILTER:-*}" \
  "VANTAGE_DATA=${VANTAGE_DATA:-$here/../../../shared/data}"
