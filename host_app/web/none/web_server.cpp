#include "host_app/web/web_server.h"

#include "common/base/error.h"

namespace vantage {
namespace {

constexpr const char* no_web =
    "this program serves no page: it was built without VANTAGE_WEB, which needs libmicrohttpd and "
    "GnuTLS";

}  // namespace

void WebServer::Stop::operator()(MHD_Daemon*) const {}

void require_web_url(const std::string&) { fail(no_web); }

WebServer::WebServer(const std::string&, OperatorInputBox&) { fail(no_web); }

WebServer::~WebServer() = default;

}  // namespace vantage
