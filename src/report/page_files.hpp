#pragma once

#include <incise/core/error.hpp>
#include <incise/io/embedded_file.hpp>

#include <fmt/format.h>

namespace incise::page {

/// The files of src/report/page, and three.js of web/.
[[nodiscard]] std::span<const EmbeddedFile> files();

/// The content of one of them. @throws InvalidArgument for a name that none has.
[[nodiscard]] inline std::string_view file(std::string_view name) {
  const EmbeddedFile* found = find_embedded(files(), name);
  INCISE_REQUIRE(found != nullptr, fmt::format("expected a file of the report's page, found {}", name));
  return found->content;
}

}  // namespace incise::page
