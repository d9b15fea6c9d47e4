#pragma once

#include <string>
#include <string_view>

namespace incise {

/// three.js as a classic script that defines THREE: its two modules as functions, one within the other. A page on a
/// disk cannot import one module from another.
/// @param core, module  three.core.js, and three.module.js, which imports from it and exports it again.
/// @throws InvalidArgument for modules of another form.
[[nodiscard]] std::string three_script(std::string_view core, std::string_view module);

}  // namespace incise
