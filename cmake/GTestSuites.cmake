# Suites of a GoogleTest executable as tests of ctest.
#
#   tachylite_gtest_suites(TARGET LABEL label [SUFFIX suffix] [EXCLUDE filter] [ENVIRONMENT NAME=value])
#
# registers each suite, whatever its instantiation, as SUITE and the suffix; one process runs all of its cases but those
# that `filter` matches. ctest asks the executable itself, so that no suite is missed. Those of the list `long_suites`
# begin first.
function(tachylite_gtest_suites target)
  cmake_parse_arguments(arg "" "LABEL;SUFFIX;EXCLUDE;ENVIRONMENT" "" ${ARGN})
  set(script ${CMAKE_CURRENT_BINARY_DIR}/${target}${arg_SUFFIX}_suites.cmake)
  file(GENERATE OUTPUT ${script} CONTENT "set(program [[$<TARGET_FILE:${target}>]])
set(label [[${arg_LABEL}]])
set(suffix [[${arg_SUFFIX}]])
set(exclude [[${arg_EXCLUDE}]])
set(environment [[${arg_ENVIRONMENT}]])
set(long_suites [[${long_suites}]])
include([[${PROJECT_SOURCE_DIR}/cmake/add_gtest_suites.cmake]])
")
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${script})
endfunction()
