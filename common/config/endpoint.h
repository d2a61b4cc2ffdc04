#pragma once

#include <string>
#include <string_view>

namespace vantage {

enum class EndpointUse {
    bind,    ///< the port may be `*`: the system chooses one
    connect  ///< the port must be a number
};

/// What is wrong with a stream endpoint ("tcp://HOST:PORT" or "ipc://PATH"), as the end of a
/// sentence that begins with its key; empty if nothing is.
std::string endpoint_fault(std::string_view endpoint, EndpointUse use);

/// The same for a CURVE public or secret key in Z85: 40 characters of that alphabet.
std::string z85_key_fault(std::string_view key);

}  // namespace vantage
