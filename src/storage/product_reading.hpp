#pragma once

#include <incise/core/error.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>

namespace incise {

/// Reads what an earlier run left in `folder`. Damage there is not the person's fault, and one step mends it.
/// @throws DataError that ends with the hint to remove the folder.
template <class Read>
auto of_earlier_run(const std::filesystem::path& folder, Read read) -> decltype(read()) {
  const std::string hint = fmt::format("Remove the folder {} to compute it anew", folder.string());
  try {
    return read();
  } catch (const DataError& error) {
    const std::string text = error.what();
    if (text.find("Remove the folder") != std::string::npos) throw;
    DataError hinted = error;
    static_cast<Error&>(hinted) = Error(text + ". " + hint);
    throw hinted;
  } catch (const nlohmann::json::exception& error) {
    throw DataError(folder, "", error.what(), "what an earlier run wrote", hint);
  }
}

}  // namespace incise
