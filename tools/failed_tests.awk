# Of what ctest --output-on-failure printed: the lines of each test that failed that say why, at most 60. Of a program of
# GoogleTest these are each failure up to the name of its test, and the last lines, where it may have crashed.
function close_test(  i, first) {
  if (!telling) return
  first = is_gtest ? count - 11 : count - 59
  for (i = 1; i <= count; ++i)
    if (i == 1 || kept[i] && said < 60 || i >= first) { print line[i]; ++said }
  telling = 0
}
/^ *[0-9]+\/[0-9]+ Test +#/ {
  close_test()
  telling = /\*\*\*/ && !/Skipped/
  count = said = is_gtest = keeping = 0
  delete kept
}
/^[0-9]+% tests passed/ { close_test(); exit }
telling {
  line[++count] = $0
  if (/^\[==========\]/) is_gtest = 1
  if (/: Failure$|ERROR: |WARNING: ThreadSanitizer/) keeping = 1
  kept[count] = keeping
  if (/^\[  FAILED  \]/) keeping = 0
}
END { close_test() }
