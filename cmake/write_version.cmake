# Run at build time with SOURCE, TEMPLATE, OUTPUT: fills in the git hash, touching OUTPUT only when it changes.

set(hash unknown)
execute_process(COMMAND git -C "${SOURCE}" rev-parse --short=12 HEAD
  OUTPUT_VARIABLE commit RESULT_VARIABLE status ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
if(status EQUAL 0)
  set(hash "${commit}")
  execute_process(COMMAND git -C "${SOURCE}" status --porcelain --untracked-files=no
    OUTPUT_VARIABLE changes ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
  if(changes)
    string(APPEND hash "-dirty")
  endif()
endif()
file(READ "${TEMPLATE}" text)
string(REPLACE "<git hash>" "${hash}" text "${text}")
set(old "")
if(EXISTS "${OUTPUT}")
  file(READ "${OUTPUT}" old)
endif()
if(NOT text STREQUAL old)
  file(WRITE "${OUTPUT}" "${text}")
endif()
