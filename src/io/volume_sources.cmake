# Volumes: the only sources that see ITK and GDCM (which ITK brings). Single image formats go through ITK's
# readers, DICOM through GDCM itself, because rescale, padding and position belong to each slice.
#
# incise_io is a static library, so whoever links the installed package links these too: its config file needs
#   find_dependency(ITK 5.2 COMPONENTS <the components below>)
#   find_dependency(ZLIB)
# Debian: libinsighttoolkit5-dev, and libgdcm-tools (GDCM's own CMake files look for its programs).
set(INCISE_IO_ITK_COMPONENTS ITKCommon ITKIOImageBase ITKIONRRD ITKIONIFTI ITKIOMeta ITKGDCM)
find_package(ITK 5.2 REQUIRED COMPONENTS ${INCISE_IO_ITK_COMPONENTS} GLOBAL)
find_package(ZLIB REQUIRED)   # to count what is packed in a file; ITK needs it as well
list(APPEND ITK_LIBRARIES ZLIB::ZLIB)
set_property(GLOBAL PROPERTY INCISE_IO_ITK_COMPONENTS ${INCISE_IO_ITK_COMPONENTS})

# ITK's imported targets carry no include folders; added once incise_io exists.
cmake_language(DEFER CALL target_include_directories incise_io SYSTEM PRIVATE ${ITK_INCLUDE_DIRS})

set(volume_sources
  volume_complete.cpp
  volume_dicom_file.cpp
  volume_dicom_header.cpp
  volume_dicom_read.cpp
  volume_dicom_write.cpp
  volume_io.cpp
  volume_itk.cpp
  volume_nrrd_header.cpp
  volume_pictures.cpp
  volume_quiet.cpp
  volume_stack.cpp)
