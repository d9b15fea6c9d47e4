# find_package(incise): export set, headers and a config file that finds our own dependencies. A project that holds incise as a
# subproject installs what it wants itself.
if(NOT PROJECT_IS_TOP_LEVEL)
  return()
endif()
include(CMakePackageConfigHelpers)
get_property(module_targets GLOBAL PROPERTY INCISE_MODULE_TARGETS)
set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/incise)

install(TARGETS ${module_targets} EXPORT inciseTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(EXPORT inciseTargets NAMESPACE incise:: DESTINATION ${package_folder})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/incise DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.hpp")

# As src/io and src/imaging ask for them.
get_property(INCISE_ITK_COMPONENTS GLOBAL PROPERTY INCISE_IO_ITK_COMPONENTS)
list(APPEND INCISE_ITK_COMPONENTS ITKConnectedComponents ITKSmoothing)
list(JOIN INCISE_ITK_COMPONENTS " " INCISE_ITK_COMPONENTS)
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/incise-config.cmake.in ${PROJECT_BINARY_DIR}/incise-config.cmake
  INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/incise-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/incise-config.cmake ${PROJECT_BINARY_DIR}/incise-config-version.cmake
              ${PROJECT_SOURCE_DIR}/cmake/IncisePackages.cmake
  DESTINATION ${package_folder})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})

# tests/consumer is an outside project: it is built against an installed copy, not as part of this one.
if(INCISE_BUILD_TESTS)
  string(TOUPPER "${CMAKE_BUILD_TYPE}" build_type)
  add_test(NAME consumer.builds_against_the_installed_package
    COMMAND ${CMAKE_COMMAND} -DINCISE_BUILD=${PROJECT_BINARY_DIR} -DINCISE_SOURCE=${PROJECT_SOURCE_DIR}
      -DWORK=${PROJECT_BINARY_DIR}/consumer_test -DGENERATOR=${CMAKE_GENERATOR} -DCXX=${CMAKE_CXX_COMPILER}
      -DBUILD_TYPE=${CMAKE_BUILD_TYPE} "-DFLAGS=${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${build_type}}"
      -P ${PROJECT_SOURCE_DIR}/tests/consumer/run.cmake)
  set_tests_properties(consumer.builds_against_the_installed_package PROPERTIES LABELS long TIMEOUT ${INCISE_TEST_STOP_S})
endif()
