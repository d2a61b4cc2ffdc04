#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "host_app/web/web_desk.h"

struct MHD_Daemon;

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

/// Serves the page for tablets and phones over HTTP or HTTPS, on a thread of its own per address.
/// It serves 100 connections, and closes one that is silent for 20 seconds. Thread-safe.
class WebServer {
  public:
    /// `url`: "http://HOST:PORT" or "https://HOST:PORT"; without a host at 127.0.0.1. Options:
    /// control=yes, pin=DIGITS or pin-file=FILE, certificate=FILE and key=FILE, open=yes, and
    /// board=COLUMNSxROWS or board=FILE. Beyond this computer it takes HTTPS and open=yes; without
    /// a PIN one is made and logged. Throws Error for an address that is in use or not allowed.
    /// `input` must outlive it.
    WebServer(const std::string& url, OperatorInputBox& input);
    ~WebServer();
    WebServer(const WebServer&) = delete;
    WebServer& operator=(const WebServer&) = delete;

    void show(WebShown shown) { desk_->show(std::move(shown)); }
    WebStats stats() const { return desk_->stats(); }

  private:
    struct Stop {
        void operator()(MHD_Daemon* daemon) const;
    };
    std::optional<WebCertificate> certificate_;
    std::unique_ptr<WebDesk> desk_;
    std::vector<std::unique_ptr<MHD_Daemon, Stop>> daemons_;  ///< one for each address
};

/// Throws Error for a URL that WebServer would refuse, without opening anything.
void require_web_url(const std::string& url);

}  // namespace vantage
