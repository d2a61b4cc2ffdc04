#include "rig_firmware/pairing/paired_files.h"

#include <utility>

#include <grp.h>
#include <sys/stat.h>
#include <unistd.h>

#include "common/base/error.h"
#include "common/base/files/atomic_file.h"
#include "common/config/endpoint.h"
#include "common/config/toml_edit.h"

namespace vantage {
namespace {

constexpr std::size_t max_file_bytes = 1 << 20;
/// The group that the daemon runs as, where its package is installed.
constexpr const char* service_group = "vantage";
constexpr mode_t secret_mode = 0640;

/// The service may read it and nobody else may. Without the service it stays its owner's.
void hand_to_service(const std::filesystem::path& file) {
    const group* service = ::getgrnam(service_group);
    if (::geteuid() != 0 || !service) return;
    if (::chown(file.c_str(), 0, service->gr_gid) != 0 || ::chmod(file.c_str(), secret_mode) != 0)
        fail("{} cannot be given to the group {}: chown root:{} {}, then chmod 640 {}",
             file.string(), service_group, service_group, file.string(), file.string());
}

/// The file keeps whose it is and who may read it.
void rewrite(const std::filesystem::path& file, const std::string& text) {
    struct stat facts {};
    const bool was_there = ::stat(file.c_str(), &facts) == 0;
    write_text_atomically(file, text);
    if (was_there && (::chown(file.c_str(), facts.st_uid, facts.st_gid) != 0 ||
                      ::chmod(file.c_str(), facts.st_mode & 07777) != 0))
        fail("{} was written and its owner or mode could not be kept", file.string());
}

}  // namespace

PairedFiles::PairedFiles(std::filesystem::path config)
    : file_(std::move(config)), config_(load_rig_config(file_)) {
    const std::filesystem::path folder = std::filesystem::absolute(file_).parent_path();
    key_file_ = config_.stream.key_file.empty() ? folder / "rig.key" : config_.stream.key_file;
    hosts_file_ = config_.stream.authorized_hosts.empty() ? folder / "hosts.keys"
                                                          : config_.stream.authorized_hosts;
}

CurveKeys PairedFiles::own_keys() const {
    if (!std::filesystem::exists(key_file_)) {
        write_key_file(key_file_, generate_curve_keys());
        hand_to_service(key_file_);
    }
    return load_key_file(key_file_);
}

std::vector<std::string> PairedFiles::admit(const PairReveal& host, bool for_others) {
    std::string hosts;
    const bool had_list = std::filesystem::exists(hosts_file_);
    if (had_list) hosts = read_text_file(hosts_file_, max_file_bytes);
    if (!had_list || !load_authorized_hosts(hosts_file_).contains(host.public_key)) {
        if (!hosts.empty() && hosts.back() != '\n') hosts += '\n';
        rewrite(hosts_file_, hosts + host.public_key + ' ' + host.host + '\n');
        if (!had_list) hand_to_service(hosts_file_);
    }
    std::string text = read_text_file(file_, max_file_bytes);
    std::vector<std::string> changes;
    const auto set = [&](const char* key, const std::string& value) {
        text = with_toml_value(text, "stream", key, toml_string(value), file_);
        changes.push_back(fmt::format("{} = {}", key, toml_string(value)));
    };
    // Relative paths are relative to the file's folder.
    if (config_.stream.authorized_hosts.empty())
        set("authorized_hosts", hosts_file_.filename().string());
    if (config_.stream.key_file.empty()) set("key_file", key_file_.filename().string());
    const Endpoint bind = parse_endpoint(config_.stream.bind, "stream.bind");
    if (for_others && bind.loopback) set("bind", "tcp://*:" + bind.port);
    if (!changes.empty()) rewrite(file_, text);
    config_ = load_rig_config(file_);
    return changes;
}

}  // namespace vantage
