#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace incise::studio {

struct ServerSettings {
  std::filesystem::path case_file;           ///< opened at the start; empty: none
  std::vector<std::filesystem::path> roots;  ///< folders whose files may be opened; at least one
  unsigned short port = 0;                   ///< port on 127.0.0.1; 0: a free one
  std::vector<std::string> worker;           ///< command of a worker; the folder for its arrays is appended
};

/// Serves the studio's page on 127.0.0.1 until SIGINT or SIGTERM: see docs/decisions/0009-studio.md. Uses one thread;
/// workers do all computations, and end with it.
/// @param on_ready  called with the address, token included, once it can be opened.
/// @throws DataError for roots, a case or a temporary folder that cannot be used; CaseError for a port that is in use.
void serve(const ServerSettings& settings, const std::function<void(const std::string& address)>& on_ready);

}  // namespace incise::studio
