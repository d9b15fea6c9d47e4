#pragma once

#include <incise/io/embedded_file.hpp>

namespace incise::studio::page {

/// The files of src/studio/page, and those of web/lib as lib/NAME.
[[nodiscard]] std::span<const EmbeddedFile> files();

}  // namespace incise::studio::page
