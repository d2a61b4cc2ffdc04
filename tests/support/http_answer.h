#pragma once

#include <string>

namespace vantage {

/// A local server's answer to these bytes, until it closes the connection; empty: no server.
std::string http_answer(int port, const std::string& request);
/// The answer to a request that asks the server to close the connection.
std::string http_answer(int port, const std::string& method, const std::string& path);

}  // namespace vantage
