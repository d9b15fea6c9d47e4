# Writes version.cpp with the commit and the digest of the sources; run at every build, it touches the file only when an
# answer changes. Called as: cmake -DSOURCE_DIR=… -DVERSION=… -DCOMPILER=… -DOUTPUT=… -P InciseVersion.cmake
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
# Name and contents of everything that the library is compiled from, committed or not; version, compiler, flags.
file(GLOB_RECURSE sources LIST_DIRECTORIES false RELATIVE ${SOURCE_DIR}
     ${SOURCE_DIR}/src/*.cpp ${SOURCE_DIR}/src/*.hpp ${SOURCE_DIR}/src/*.inc ${SOURCE_DIR}/src/CMakeLists.txt
     ${SOURCE_DIR}/src/*.cmake ${SOURCE_DIR}/include/*.hpp ${SOURCE_DIR}/include/*.inc
     ${SOURCE_DIR}/cmake/*.cmake)
list(SORT sources)
set(listing "${VERSION} ${COMPILER}\n")
foreach(source ${sources})
  file(SHA256 ${SOURCE_DIR}/${source} digest)
  string(APPEND listing "${digest} ${source}\n")
endforeach()
string(SHA256 digest "${listing}")
set(text "#include <incise/core/version.hpp>

namespace incise {
std::string_view version() { return \"${VERSION}\"; }
std::string_view source_commit() { return \"${commit}\"; }
std::string_view source_digest() { return \"${digest}\"; }
}  // namespace incise
")
set(old "")
if(EXISTS ${OUTPUT})
  file(READ ${OUTPUT} old)
endif()
if(NOT old STREQUAL text)
  file(WRITE ${OUTPUT} "${text}")
endif()
