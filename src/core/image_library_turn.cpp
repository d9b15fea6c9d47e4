#include <incise/core/image_library_turn.hpp>

namespace incise {
namespace {

/// One lock for the whole process, because the libraries' own state belongs to the whole process.
std::mutex& the_turn() {
  static std::mutex mutex;
  return mutex;
}

}  // namespace

ImageLibraryTurn::ImageLibraryTurn() : turn_(the_turn()) {}

}  // namespace incise
