# Files made of text or plain bytes: everything but volumes. XML is parsed by pugixml, compressed by libdeflate; both stay private.
find_package(pugixml REQUIRED)
find_package(ZLIB REQUIRED)
set(text_sources
  atomic_file.cpp
  child_process.cpp
  contour_io.cpp
  durable.cpp
  entry_folder.cpp
  folder_lock.cpp
  gmsh_reader.cpp
  input_file.cpp
  jpeg_file.cpp
  json_text.cpp
  manifest.cpp
  mesh_io.cpp
  number_text.cpp
  obj_reader.cpp
  path_io.cpp
  picture_io.cpp
  ply_format.cpp
  png_file.cpp
  pvd_io.cpp
  sha256.cpp
  stl_reader.cpp
  surface_io.cpp
  surface_problems.cpp
  table_io.cpp
  tetgen_reader.cpp
  text_cursor.cpp
  text_encoding.cpp
  text_table.cpp
  tiff_file.cpp
  transform_json.cpp
  vtk_bytes.cpp
  vtk_legacy_reader.cpp
  vtk_xml_reader.cpp
  vtk_xml_writer.cpp
  specimen_id.cpp)
set(text_libraries pugixml::pugixml incise_deflate ZLIB::ZLIB PNG::PNG JPEG::JPEG TIFF::TIFF)
