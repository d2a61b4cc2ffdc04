#include "common/wire/curve_keys.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <sstream>

#include <fcntl.h>
#include <grp.h>
#include <pwd.h>
#include <sys/stat.h>
#include <toml++/toml.h>
#include <unistd.h>
#include <zmq.h>

#include "common/base/error.h"
#include "common/base/files/atomic_file.h"

namespace vantage {
namespace {

constexpr std::size_t z85_chars = 40;
constexpr std::size_t key_bytes = 32;
constexpr std::size_t max_key_file_bytes = 64 * 1024;
constexpr int key_file_version = 1;

using Z85Buffer = std::array<char, z85_chars + 1>;

/// The user and group of the rig's daemon where its package is installed.
constexpr const char* service_name = "vantage";

KeyFileReader this_reader() {
    KeyFileReader reader{.users = {0, ::geteuid()}, .groups = {::getegid()}};
    // An administrator may read the service's own files.
    if (const passwd* service = ::getpwnam(service_name)) reader.users.insert(service->pw_uid);
    if (const group* service = ::getgrnam(service_name)) reader.groups.insert(service->gr_gid);
    return reader;
}

void refuse_if_others_can_read(const std::filesystem::path& path) {
    struct stat facts {};
    if (::stat(path.c_str(), &facts) != 0)
        fail("cannot read key file {}: {}", path.string(), std::strerror(errno));
    const std::string fault =
        key_file_fault({facts.st_uid, facts.st_gid, facts.st_mode}, this_reader());
    if (!fault.empty()) fail("key file {} {} {}", path.string(), fault, path.string());
    if (::access(path.c_str(), R_OK) != 0)
        fail(
            "key file {} cannot be read by this user; for the service: chown root:{} {}, then "
            "chmod 640 {}",
            path.string(), service_name, path.string(), path.string());
}

}  // namespace

std::string key_file_fault(const KeyFileFacts& file, const KeyFileReader& reader) {
    constexpr mode_t permissions = S_IRWXU | S_IRWXG | S_IRWXO;
    if (!reader.users.contains(file.owner))
        return fmt::format(
            "belongs to user {}, who is neither root nor the user reading it; chown root",
            file.owner);
    if ((file.mode & S_IRWXO) != 0)
        return fmt::format("is open to everybody (mode {:o}); chmod o=", file.mode & permissions);
    if ((file.mode & (S_IWGRP | S_IXGRP)) != 0)
        return fmt::format("can be changed by its group (mode {:o}); chmod g=r",
                           file.mode & permissions);
    if ((file.mode & S_IRGRP) != 0 && !reader.groups.contains(file.group))
        return fmt::format(
            "can be read by group {}, which is not the service's (mode {:o}); chmod 600",
            file.group, file.mode & permissions);
    return "";
}

CurveKeys generate_curve_keys() {
    Z85Buffer public_key{};
    Z85Buffer secret_key{};
    if (zmq_curve_keypair(public_key.data(), secret_key.data()) != 0)
        fail("this computer's libzmq cannot make CURVE keys: {}", zmq_strerror(zmq_errno()));
    return {public_key.data(), secret_key.data()};
}

void write_key_file(const std::filesystem::path& path, const CurveKeys& keys) {
    const std::string text = fmt::format(
        "# CURVE key pair of Vantage. The secret half stays on this computer; give the public half "
        "to the other end.\n"
        "version = {}\npublic = \"{}\"\nsecret = \"{}\"\n",
        key_file_version, keys.public_key, keys.secret_key);
    const int fd = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, S_IRUSR | S_IWUSR);
    if (fd < 0 && errno == EEXIST)
        fail("{} exists and is not replaced; remove it first if you no longer need its key",
             path.string());
    if (fd < 0) fail("cannot write {}: {}", path.string(), std::strerror(errno));
    const bool whole = ::write(fd, text.data(), text.size()) == static_cast<ssize_t>(text.size()) &&
                       ::fsync(fd) == 0;
    const int reason = errno;
    if (::close(fd) != 0 || !whole) {
        ::unlink(path.c_str());
        fail("cannot write {}: {}", path.string(), std::strerror(reason));
    }
}

CurveKeys load_key_file(const std::filesystem::path& path) {
    refuse_if_others_can_read(path);
    toml::table table;
    try {
        table = toml::parse(read_text_file(path, max_key_file_bytes));
    } catch (const toml::parse_error& error) {
        fail("key file {} line {} is not TOML: {}", path.string(), error.source().begin.line,
             error.description());
    }
    // Not value_or(): toml++ would convert a fraction or a huge number to an integer.
    const toml::value<std::int64_t>* version = table["version"].as_integer();
    if (!version || version->get() != key_file_version)
        fail("key file {} is not of version {}; make one with: keys new FILE", path.string(),
             key_file_version);
    CurveKeys keys;
    keys.public_key = table["public"].value_or(std::string());
    keys.secret_key = table["secret"].value_or(std::string());
    if (!is_curve_key(keys.public_key))
        fail("key file {} has no valid public key ({} characters of Z85)", path.string(),
             z85_chars);
    if (!is_curve_key(keys.secret_key))
        fail("key file {} has no valid secret key ({} characters of Z85)", path.string(),
             z85_chars);
    Z85Buffer expected{};
    if (zmq_curve_public(expected.data(), keys.secret_key.c_str()) != 0 ||
        keys.public_key != expected.data())
        fail("the two keys of {} do not belong together; make a new pair with: keys new FILE",
             path.string());
    return keys;
}

bool is_curve_key(std::string_view text) {
    constexpr std::string_view alphabet =
        "0123456789abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ.-:+=^!/*?&<>()[]{}@%$#";
    if (text.size() != z85_chars || text.find_first_not_of(alphabet) != std::string_view::npos)
        return false;
    std::array<std::uint8_t, key_bytes> bytes{};
    return zmq_z85_decode(bytes.data(), std::string(text).c_str()) != nullptr;
}

std::map<std::string, std::string> load_authorized_hosts(const std::filesystem::path& path) {
    std::map<std::string, std::string> hosts;
    std::istringstream text(read_text_file(path, max_key_file_bytes));
    std::string line;
    for (int number = 1; std::getline(text, line); ++number) {
        std::istringstream words(line);
        std::string key;
        words >> key;
        if (is_curve_key(key)) {
            std::string name;
            std::getline(words >> std::ws, name);
            hosts[key] = name;
        } else if (!key.empty() && key.front() != '#') {
            fail("{} line {} does not begin with a public key of {} characters", path.string(),
                 number, z85_chars);
        }
    }
    return hosts;
}

}  // namespace vantage
