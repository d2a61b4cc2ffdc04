#pragma once

#include <string>
#include <string_view>

namespace vantage {

/// The text with what nobody else may read taken out, for reports that people send: keys of every
/// kind (40 characters of Z85), values that are named key, secret, passphrase, password, token or
/// streamid, in files, URLs and command lines, and users' names and passwords in URLs. Paths of
/// key files stay. What is taken out is replaced by [left out].
std::string without_secrets(std::string_view text);

}  // namespace vantage
