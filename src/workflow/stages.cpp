#include <incise/workflow/study.hpp>

#include <fmt/format.h>

namespace incise {

}  // namespace incise
