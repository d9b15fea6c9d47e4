#include <incise/core/error.hpp>
#include <incise/core/monitor.hpp>

#include <string>

namespace incise {

void throw_if_cancelled(const Monitor& monitor, std::string_view stage) {
  if (monitor.is_cancelled()) throw Cancelled(std::string(stage) + " was interrupted");
}

}  // namespace incise
