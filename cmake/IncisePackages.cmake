# Every outside library, found once. Each belongs to one module, which links it privately where it can.
find_package(Threads REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(fmt REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(yaml-cpp REQUIRED)
find_package(OpenSSL REQUIRED)        # SHA-256, in core
find_package(nanoflann REQUIRED)      # nearest points, in geometry

find_package(OpenMP REQUIRED COMPONENTS CXX)   # only to hold CHOLMOD's own threads back

# CHOLMOD has neither a CMake nor a pkg-config file in Debian 12. OpenBLAS is linked directly, so that
# openblas_set_num_threads acts on the library that CHOLMOD uses.
find_path(CHOLMOD_INCLUDE_DIR cholmod.h PATH_SUFFIXES suitesparse REQUIRED)
find_library(CHOLMOD_LIBRARY cholmod REQUIRED)
find_library(OPENBLAS_LIBRARY openblas REQUIRED)
if(NOT TARGET incise_cholmod)
  add_library(incise_cholmod INTERFACE IMPORTED GLOBAL)   # so that the installed package can define it again
  target_include_directories(incise_cholmod SYSTEM INTERFACE ${CHOLMOD_INCLUDE_DIR})
  target_link_libraries(incise_cholmod INTERFACE ${OPENBLAS_LIBRARY} ${CHOLMOD_LIBRARY} OpenMP::OpenMP_CXX)
endif()

# OpenCV's CMake file comes with its whole development package only; two of its modules are all that photographs need, in imaging.
find_path(OPENCV_INCLUDE_DIR opencv2/core.hpp PATH_SUFFIXES opencv4 REQUIRED)
find_library(OPENCV_CORE_LIBRARY opencv_core REQUIRED)
find_library(OPENCV_IMGPROC_LIBRARY opencv_imgproc REQUIRED)
if(NOT TARGET incise_opencv)
  add_library(incise_opencv INTERFACE IMPORTED GLOBAL)
  target_include_directories(incise_opencv SYSTEM INTERFACE ${OPENCV_INCLUDE_DIR})
  target_link_libraries(incise_opencv INTERFACE ${OPENCV_IMGPROC_LIBRARY} ${OPENCV_CORE_LIBRARY})
endif()
# Photographs and depth pictures, in io. OpenCV's own module for them brings GDAL and 85 libraries more, and paints over what is damaged.
find_package(PNG REQUIRED)
find_package(JPEG REQUIRED)
find_package(TIFF 4.5 REQUIRED)
find_package(Boost 1.74 REQUIRED)     # headers only: Boost.Math in evaluation (distributions), Boost.Beast in studio (HTTP)

# librsvg has a pkg-config file only. It turns figures into PNG, in report.
find_package(PkgConfig REQUIRED)
pkg_check_modules(RSVG REQUIRED librsvg-2.0>=2.52)
if(NOT TARGET incise_rsvg)
  add_library(incise_rsvg INTERFACE IMPORTED GLOBAL)
  target_include_directories(incise_rsvg SYSTEM INTERFACE ${RSVG_INCLUDE_DIRS})
  target_link_libraries(incise_rsvg INTERFACE ${RSVG_LINK_LIBRARIES})
endif()
# libdeflate, too, has a pkg-config file only (Debian 12). It packs and unpacks the arrays of VTK files, in io.
pkg_check_modules(DEFLATE REQUIRED libdeflate>=1.14)
if(NOT TARGET incise_deflate)
  add_library(incise_deflate INTERFACE IMPORTED GLOBAL)
  target_include_directories(incise_deflate SYSTEM INTERFACE ${DEFLATE_INCLUDE_DIRS})
  target_link_libraries(incise_deflate INTERFACE ${DEFLATE_LINK_LIBRARIES})
endif()
