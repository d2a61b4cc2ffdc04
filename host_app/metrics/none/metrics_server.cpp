#include "host_app/metrics/metrics_server.h"

#include "common/base/error.h"

namespace vantage {

void MetricsServer::Stop::operator()(MHD_Daemon*) const {}

MetricsServer::MetricsServer(const std::string&) {
    fail(
        "this program serves no metrics: it was built without VANTAGE_METRICS, which needs "
        "libmicrohttpd");
}

MetricsServer::~MetricsServer() = default;

void MetricsServer::show(std::string) {}

std::shared_ptr<const std::string> MetricsServer::shown() const { return text_; }

}  // namespace vantage
