#include <incise/core/image_library_turn.hpp>

namespace incise {
namespace {

/// The libraries' own state is one for the whole process, and so is this.
std::mutex& the_turn() {
  static std::mutex mutex;
  return mutex;
}

}  // namespace

ImageLibraryTurn::ImageLibraryTurn() : turn_(the_turn()) {}

}  // namespace incise
