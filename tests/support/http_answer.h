#pragma once

#include <string>

namespace vantage {

/// What a server of this computer answers to these bytes, until it closes; empty: nobody listens.
std::string http_answer(int port, const std::string& request);
/// To a request that asks it to close then.
std::string http_answer(int port, const std::string& method, const std::string& path);

}  // namespace vantage
