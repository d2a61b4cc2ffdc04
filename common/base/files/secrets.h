#pragma once

#include <string>
#include <string_view>

namespace vantage {

/// Removes secrets from a text, for reports that people send. Replaces by [left out]: keys of every
/// kind (40 Z85 characters); values named key, secret, passphrase, password, token or streamid in
/// files, URLs and command lines; and user names and passwords in URLs. Paths of key files stay.
std::string without_secrets(std::string_view text);

}  // namespace vantage
