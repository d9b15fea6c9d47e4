# incise_warnings: the flags that our own code is held to; never imposed on a project that uses the library.
add_library(incise_warnings INTERFACE)
target_compile_options(incise_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual
  $<$<CXX_COMPILER_ID:GNU>:-Werror>  # clang has other warnings: it builds the fuzz targets alone
  -Wno-missing-field-initializers    # settings are aggregates: what is not named keeps its default
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)  # g++ 12 sees overlaps in std::string operator+ that are not there (GCC bug 105651)

option(INCISE_UNITY_BUILD "Compile the sources of a target in groups: less to compile from scratch, more after a small change"
       ${PROJECT_IS_TOP_LEVEL})

# Most of what a source takes to compile is the headers that it shares with its neighbours; a group of sources reads them once. Within a
# target that is compiled so, no two sources may have a private name in common. The presets dev and coverage compile each source by itself:
# clang-tidy and gcovr look at them so, and a source that lacks an include shows.
function(incise_compile_in_groups target size)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${INCISE_UNITY_BUILD} UNITY_BUILD_BATCH_SIZE ${size})
endfunction()

# By default g++ collects its garbage whenever its heap has doubled from 128 MB, which takes up to a quarter of the time of a source that
# includes Eigen and fmt; most sources end before their heap has doubled from half a gigabyte. The code that comes out is the same.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND PROJECT_IS_TOP_LEVEL)
  add_compile_options(--param=ggc-min-heapsize=524288)
endif()

# Reads cmake/layers.txt and adds each module folder under src/ that exists.
function(incise_add_modules)
  file(STRINGS ${PROJECT_SOURCE_DIR}/cmake/layers.txt rows REGEX "^[0-9]")
  foreach(row IN LISTS rows)
    string(REGEX MATCH "^[0-9]+ +([a-z_]+)" ignored "${row}")
    set(module ${CMAKE_MATCH_1})
    if(EXISTS ${PROJECT_SOURCE_DIR}/src/${module}/CMakeLists.txt)
      add_subdirectory(src/${module})
    endif()
  endforeach()
endfunction()

# incise_module(<name> SOURCES … [USES <incise modules>] [PUBLIC <targets>] [PRIVATE <targets>] [LIGHT])
# Makes the target incise_<name>, alias incise::<name>, with include/ public and src/ private. LIGHT: its own code takes none of the time that
# a user waits for (it reads, writes, draws, or calls other modules), so that a release build spares a quarter of what it takes to compile;
# without fused operations -O1 and -O3 give the same bits.
function(incise_module name)
  cmake_parse_arguments(ARG "LIGHT" "" "SOURCES;USES;PUBLIC;PRIVATE" ${ARGN})
  set(target incise_${name})
  add_library(${target} STATIC ${ARG_SOURCES})
  add_library(incise::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON)
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_include_directories(${target}
    PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>
    PRIVATE ${PROJECT_SOURCE_DIR}/src)
  list(TRANSFORM ARG_USES PREPEND incise_)
  target_link_libraries(${target} PUBLIC ${ARG_USES} ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE} $<BUILD_INTERFACE:incise_warnings>)
  incise_compile_in_groups(${target} 16)
  if(ARG_LIGHT)
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
  endif()
  set_property(GLOBAL APPEND PROPERTY INCISE_MODULE_TARGETS ${target})
endfunction()

# incise_embed(<output.cpp> HEADER <private header> NAMESPACE <a::b> FILES <name=path> …): see InciseEmbed.cmake.
function(incise_embed output)
  cmake_parse_arguments(ARG "" "HEADER;NAMESPACE" "FILES" ${ARGN})
  list(TRANSFORM ARG_FILES REPLACE "^[^=]+=" "" OUTPUT_VARIABLE paths)
  set(script ${PROJECT_SOURCE_DIR}/cmake/InciseEmbed.cmake)
  add_custom_command(
    OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -DOUTPUT=${output} -DHEADER=${ARG_HEADER} -DNAMESPACE=${ARG_NAMESPACE} "-DFILES=${ARG_FILES}" -P ${script}
    DEPENDS ${paths} ${script}
    COMMENT "Embedding the files of ${ARG_NAMESPACE}"
    VERBATIM)
endfunction()

# When ctest ends a test on a machine that nobody watches. No verdict on speed: the slowest test takes minutes on a quiet machine, and one that
# hangs in the command is found by its watch (tests/cli/command.py).
set(INCISE_TEST_STOP_S 21600)

# incise_test(<module> SOURCES … [USES <incise modules>] [LINK <targets>] [LABEL unit|verification|end_to_end|long] [IN_GROUPS] [SHARDS n [SKIPPABLE <filter>]])
# One test program per folder under tests/; each TEST in it is one ctest entry. With SHARDS there are n entries, each with its share of the TESTs:
# for rooms that link imaging, whose libraries take longer to load (0.2 s) than most of their tests take to run. A TEST that
# may be skipped is an entry of its own all the same (SKIPPABLE, a filter as googletest has it), or its shard fails: no skip goes unseen.
function(incise_test name)
  cmake_parse_arguments(ARG "IN_GROUPS" "LABEL;SHARDS;SKIPPABLE" "SOURCES;USES;LINK" ${ARGN})
  if(NOT ARG_LABEL)
    set(ARG_LABEL unit)
  endif()
  set(target ${name}_test)
  add_executable(${target} ${ARG_SOURCES})
  list(TRANSFORM ARG_USES PREPEND incise_)
  # A test's own code need not be fast; what it calls is the library, built as ever. The headers all tests share are compiled once.
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
  target_precompile_headers(${target} REUSE_FROM incise_test_headers)
  if(ARG_IN_GROUPS)
    incise_compile_in_groups(${target} 8)  # a test's private names are short: more of them have a twin
  endif()
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
  target_link_libraries(${target} PRIVATE ${ARG_USES} ${ARG_LINK} incise_test_support GTest::gtest_main GTest::gmock incise_warnings)
  set(discovered)
  if(ARG_SHARDS)
    math(EXPR last "${ARG_SHARDS} - 1")
    foreach(shard RANGE ${last})
      math(EXPR number "${shard} + 1")
      add_test(NAME ${name}.${number}_of_${ARG_SHARDS} COMMAND ${target} --gtest_brief=1 --gtest_filter=-${ARG_SKIPPABLE})
      set_tests_properties(${name}.${number}_of_${ARG_SHARDS} PROPERTIES LABELS ${ARG_LABEL} TIMEOUT ${INCISE_TEST_STOP_S}
        FAIL_REGULAR_EXPRESSION "SKIPPED" ENVIRONMENT "GTEST_TOTAL_SHARDS=${ARG_SHARDS};GTEST_SHARD_INDEX=${shard}")
    endforeach()
    if(NOT ARG_SKIPPABLE)
      return()
    endif()
    set(discovered TEST_FILTER ${ARG_SKIPPABLE})
  endif()
  gtest_discover_tests(${target} ${discovered} DISCOVERY_MODE PRE_TEST TEST_PREFIX ${name}. 
    PROPERTIES LABELS ${ARG_LABEL} TIMEOUT ${INCISE_TEST_STOP_S} SKIP_REGULAR_EXPRESSION "\\[  SKIPPED \\]")
endfunction()
