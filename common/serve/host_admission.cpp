#include "common/serve/host_admission.h"

#include <array>
#include <iterator>
#include <utility>
#include <vector>
#include <zmq_addon.hpp>

#include "common/base/error.h"
#include "common/base/log.h"
#include "common/wire/curve_keys.h"

namespace vantage {
namespace {

constexpr const char* zap_endpoint = "inproc://zeromq.zap.01";
constexpr std::size_t key_bytes = 32;

/// The parts of a request in order; the last part of a CURVE request is the host's key.
enum RequestPart { version, request_id, domain, address, identity, mechanism, key, request_parts };

/// The shortest time between two log lines about one refused host.
constexpr std::chrono::seconds log_period{10};
/// The number of refused keys that are logged individually, so that a host that makes a new key
/// for each attempt does not fill the log.
constexpr std::size_t most_told = 8;

}  // namespace

HostAdmission::HostAdmission(zmq::context_t& context, std::filesystem::path authorized_hosts)
    : path_(std::move(authorized_hosts)),
      hosts_(load_authorized_hosts(path_)),
      socket_(context, zmq::socket_type::rep),
      others_(log_period) {
    std::error_code gone;
    read_version_ = std::filesystem::last_write_time(path_, gone);
    if (hosts_.empty()) log_warning("{} lists no hosts, so none is admitted", path_.string());
    socket_.set(zmq::sockopt::linger, 0);
    socket_.bind(zap_endpoint);
}

void HostAdmission::answer() {
    std::vector<zmq::message_t> request;
    if (!zmq::recv_multipart(socket_, std::back_inserter(request), zmq::recv_flags::dontwait))
        return;
    std::string user;
    bool admitted = false;
    if (request.size() == request_parts && request[mechanism].to_string_view() == "CURVE" &&
        request[key].size() == key_bytes) {
        std::array<char, 41> text{};
        zmq_z85_encode(text.data(), request[key].data<std::uint8_t>(), key_bytes);
        user = text.data();
        admitted = admits(user, request[address].to_string());
    }
    std::array<zmq::message_t, 6> reply{
        zmq::message_t(std::string("1.0")),
        request.size() > request_id ? std::move(request[request_id]) : zmq::message_t(),
        zmq::message_t(std::string(admitted ? "200" : "400")),
        zmq::message_t(std::string(admitted ? "OK" : "not in the list of authorized hosts")),
        zmq::message_t(user),
        zmq::message_t()};
    zmq::send_multipart(socket_, reply);
}

bool HostAdmission::lists(const std::string& key) {
    read_list_if_changed();
    return hosts_.contains(key);
}

void HostAdmission::read_list_if_changed() {
    std::error_code gone;
    const auto current = std::filesystem::last_write_time(path_, gone);
    if (gone || current == read_version_) return;
    read_version_ = current;
    try {
        hosts_ = load_authorized_hosts(path_);
        log_info("{} changed: {} hosts are authorized", path_.string(), hosts_.size());
    } catch (const Error& error) {
        log_warning("{}; the list read before stays in force", error.what());
    }
}

bool HostAdmission::admits(const std::string& key, const std::string& address) {
    if (lists(key)) return true;
    const MonotonicTime now = MonotonicClock::now();
    std::erase_if(told_, [&](const auto& told) { return now - told.second > log_period; });
    if (told_.contains(key)) return false;
    if (told_.size() < most_told) {
        log_warning("refused a host at {} with key {}; to admit it, add the key to {}", address,
                    key, path_.string());
        told_[key] = now;
    } else if (const auto times = others_.count(1, now)) {
        log_warning("refused hosts with further keys: {}; the last is at {}", *times, address);
    }
    return false;
}

}  // namespace vantage
