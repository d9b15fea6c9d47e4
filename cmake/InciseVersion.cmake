# Writes version.cpp with the commit of the sources; run at every build, it touches the file only when the answer changes.
# Called as: cmake -DSOURCE_DIR=… -DVERSION=… -DOUTPUT=… -P InciseVersion.cmake
execute_process(COMMAND git -C ${SOURCE_DIR} rev-parse HEAD OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE
                ERROR_QUIET RESULT_VARIABLE failed)
if(failed)
  set(commit unknown)
else()
  execute_process(COMMAND git -C ${SOURCE_DIR} status --porcelain --untracked-files=no OUTPUT_VARIABLE changes ERROR_QUIET)
  if(changes)
    string(APPEND commit -dirty)
  endif()
endif()
set(text "#include <incise/core/version.hpp>

namespace incise {
std::string_view version() { return \"${VERSION}\"; }
std::string_view source_commit() { return \"${commit}\"; }
}  // namespace incise
")
set(old "")
if(EXISTS ${OUTPUT})
  file(READ ${OUTPUT} old)
endif()
if(NOT old STREQUAL text)
  file(WRITE ${OUTPUT} "${text}")
endif()
