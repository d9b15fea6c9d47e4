# cmake -DOUTPUT=x.cpp -DHEADER=room/files.hpp -DNAMESPACE=a::b "-DFILES=name=path;…" -P InciseEmbed.cmake
# Writes a C++ source that holds text files as string literals, so that the program needs none of them when it runs. The
# header declares `std::span<const EmbeddedFile> files();` in the namespace.
set(text "#include \"${HEADER}\"\n\nnamespace ${NAMESPACE} {\n\nstd::span<const EmbeddedFile> files() {\n  static const EmbeddedFile all[] = {\n")
foreach(entry IN LISTS FILES)
  string(REGEX MATCH "^([^=]+)=(.*)$" ignored "${entry}")
  set(name ${CMAKE_MATCH_1})
  file(READ "${CMAKE_MATCH_2}" content)
  string(FIND "${content}" ")incise_file\"" clash)
  if(NOT clash EQUAL -1)
    message(FATAL_ERROR "${CMAKE_MATCH_2} holds the text that ends our string literals")
  endif()
  string(APPEND text "{\"${name}\", R\"incise_file(${content})incise_file\"},\n")
endforeach()
string(APPEND text "  };\n  return all;\n}\n\n}  // namespace ${NAMESPACE}\n")
file(WRITE "${OUTPUT}" "${text}")
