#pragma once

#include <filesystem>
#include <string>

namespace vantage {

/// A certificate for TLS and its private key, in PEM.
struct WebCertificate {
    std::string certificate, key;
    std::string fingerprint;  ///< SHA-256 of the certificate, "ab:cd:..."
};
/// Reads both files. Throws Error if they cannot be read or are no PEM.
WebCertificate read_certificate(const std::filesystem::path& certificate,
                                const std::filesystem::path& key);
/// Makes a certificate that signs itself, for this computer's name, and keeps it in `folder`; or
/// returns the one that is kept there. Throws Error if the folder cannot be written.
WebCertificate own_certificate(const std::filesystem::path& folder);

}  // namespace vantage
