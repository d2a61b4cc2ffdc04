# Counts what CTest's JUnit report tells: of a program of GoogleTest each of its tests, any other test as one.
function close_test() {
  if (status == "") return
  if (status == "fail" && !its_failed) its_failed = 1
  if (status == "run" && !is_told) its_passed = 1
  if (status == "notrun" && !its_skipped) its_skipped = 1
  passed += its_passed; failed += its_failed; skipped += its_skipped
  status = ""
}
/<testcase / {
  close_test()
  status = $0
  sub(/.* status="/, "", status)
  sub(/".*/, "", status)
  its_passed = its_failed = its_skipped = is_told = 0
}
/\[  PASSED  \] [0-9]+ test/ { is_told = 1; its_passed = number_after("PASSED  ]") }
/\[  SKIPPED \] [0-9]+ test/ { its_skipped = number_after("SKIPPED ]") }
/\[  FAILED  \] .*\([0-9]+ ms\)/ { ++its_failed }
function number_after(word) { return substr($0, index($0, word) + length(word)) + 0 }
END { close_test(); print passed + 0, failed + 0, skipped + 0 }
