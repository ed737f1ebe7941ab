# Writes OUTPUT, a C++ source with the commit of SOURCE and a hash of all files in FOLDERS (separated
# by |) below it, where that is another one than before. Without git, or in a folder that is no
# checkout of its own, the commit is unknown.
set(commit unknown)
set(git git -C ${SOURCE})
execute_process(COMMAND ${git} rev-parse --show-toplevel OUTPUT_VARIABLE top
  OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failure)
file(REAL_PATH "${SOURCE}" here)
if(NOT failure AND top STREQUAL here)
  execute_process(COMMAND ${git} rev-parse --short=12 HEAD OUTPUT_VARIABLE found
    OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failure)
  execute_process(COMMAND ${git} status --porcelain --untracked-files=no OUTPUT_VARIABLE changes
    ERROR_QUIET)
  if(NOT failure)
    set(commit ${found})
    if(changes)
      string(APPEND commit " with changes")
    endif()
  endif()
endif()

string(REPLACE "|" ";" folders "${FOLDERS}")
set(hashes)
foreach(folder IN LISTS folders)
  file(GLOB_RECURSE files RELATIVE ${SOURCE} ${SOURCE}/${folder}/*)
  list(SORT files)
  foreach(name IN LISTS files)
    file(SHA256 ${SOURCE}/${name} hash)
    string(APPEND hashes "${name} ${hash}\n")
  endforeach()
endforeach()
string(SHA256 fingerprint "${hashes}")
string(SUBSTRING ${fingerprint} 0 16 fingerprint)

set(text "namespace neve::app {

extern const char* const build_commit;
extern const char* const build_sources;
const char* const build_commit = \"${commit}\";
const char* const build_sources = \"${fingerprint}\";

}  // namespace neve::app
")
set(before)
if(EXISTS ${OUTPUT})
  file(READ ${OUTPUT} before)
endif()
if(NOT text STREQUAL before)
  file(WRITE ${OUTPUT} "${text}")
endif()
