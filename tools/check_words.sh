#!/usr/bin/env bash
# Fails on words that the project no longer uses, in file names, sources, shaders, configuration, scripts and documents.
# docs/develop/glossary.md has the words that replace them. A line that has to name an old word, since people still
# script against it, says "old name" (in a comment, or in the text itself); the changelog is not searched.
#   tools/check_words.sh [PATH...]    the whole tree, or these files and folders
set -uo pipefail
cd "$(dirname "$0")/.."
words=(
  'harmoni[sz]\w*'                               # gain compensation
  'debris'                                       # outlier pixels
  'wavering|wavers?'                             # flicker
  'novelty'                                      # source map
  'rehears\w*'                                   # warm up
  '[A-Za-z_]*[Bb]ooks(?!_third)'                       # stats
  'wish\w*|\w*Wish\w*|\w+_wish\w*'               # request
  'stead(?:y|ied)[_ ]colours?|steadied'          # temporal denoising
  'better(?:ed|ing|ings|s)|Bettered\w*'          # multi-view refinement, refine
  '\w*[Cc]onsensus\w*'                           # multi-view refinement
  '\w*harmony\w*'                                # gain compensation
  'edge[_ ]trust\w*|EdgeTrust\w*|sureness'       # edge confidence
  '[a-z_]*unlike(?:ness|_\w+)|\w+_unlike'        # cost
  'learnt[_ ]sets?|LearntSet|set[_ ]learner|SetLearner|matched[_ ]sets?|set[_ ]memory|SetMemory' # background
  '(?:like|knows|known|its|the)[_-]set|(?:before|behind|over|like) (?:the|a|its|their) sets?' # background
  '[Hh]elms?|[Pp]ilots?|Pilot\w+|\w+Pilot'       # flight controller, camera source
  'right[_ ]of[_ ]way|RightOfWay|driver[_ ]turn|DriverTurn' # render priority, driver lock
  'time[_ ]share|TimeShare|[Aa]llowance'         # time budget
  'SetDesk|TakeDesk|OutputDesk|ControlDesk|WheelDesk|(?:set|take|output|control|wheel)_desk' # see the glossary
  'jog[_ ]deck|JogDeck'                          # jog devices
  '[Hh]and[_ ]?[Ww]atch|hand[_ ]to[_ ]picture'   # input latency
  'thinned'                                      # skipped
  'pushed out'                                   # dropped at rig
  'superseded'                                   # replaced by newer
  'pictures? a second'                           # frames per second
  'no novelty'
)
pattern="(?<![A-Za-z])(?:$(IFS='|'; echo "${words[*]}"))(?![a-z])"
paths=("$@")
[ ${#paths[@]} -gt 0 ] || paths=(.)
found=$(git ls-files -- "${paths[@]}" ':!CHANGELOG.md' ':!tools/check_words.sh' ':!docs/pictures' ':!LICENSE' |
  xargs -d '\n' grep -nP "$pattern" /dev/null 2>/dev/null | grep -v 'old name')
names=$(git ls-files -- "${paths[@]}" ':!docs/pictures' | grep -P "$pattern")
if [ -n "$found$names" ]; then
  printf '%s\n' "$found" "$names" | sed '/^$/d' | cut -c1-200
  echo "words: the lines above use words that docs/develop/glossary.md replaces" >&2
  exit 1
fi
echo "words: none of those that the glossary replaces"
