# Sources are read and nothing is made of them: what another compiler minds is found in a sixth of
# the time that a build takes, and what clang-tidy minds as well (NEVE_TIDY) in half of it. Objects,
# archives and programs are empty files, there for the build tool, which has only those sources read
# again that changed.
set(made "${CMAKE_COMMAND} -E touch <OBJECT>")
set(NEVE_COMPILER_READS
  "<CMAKE_CXX_COMPILER> <DEFINES> <INCLUDES> <FLAGS> -fsyntax-only <SOURCE>" "${made}")
if(NEVE_TIDY)
  find_program(NEVE_CLANG_TIDY clang-tidy-14 REQUIRED)
  # It says what the compiler would say too. Of the preprocessor come the headers that were read; of
  # clang-tidy's other stream the numbers of warnings in headers of others.
  set(NEVE_TIDY_READS
    "<CMAKE_CXX_COMPILER> <DEFINES> <INCLUDES> <FLAGS> -E <SOURCE> >/dev/null"
    "${NEVE_CLANG_TIDY} --quiet --config-file=\"${PROJECT_SOURCE_DIR}/.clang-tidy\" <SOURCE> -- <CMAKE_CXX_COMPILER> <DEFINES> <INCLUDES> <FLAGS> 2>/dev/null"
    "${made}")
else()
  set(NEVE_TIDY_READS ${NEVE_COMPILER_READS})
endif()
set(CMAKE_CXX_COMPILE_OBJECT ${NEVE_TIDY_READS})
foreach(rule ARCHIVE_CREATE LINK_EXECUTABLE)
  set(CMAKE_CXX_${rule} "${CMAKE_COMMAND} -E touch <TARGET>")
endforeach()
set(CMAKE_CXX_ARCHIVE_APPEND "")
set(CMAKE_CXX_ARCHIVE_FINISH "")
# Tests that do not run cannot be asked for their names.
set(CMAKE_GTEST_DISCOVER_TESTS_DISCOVERY_MODE PRE_TEST)
