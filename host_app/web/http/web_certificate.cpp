#include <array>
#include <ctime>
#include <memory>
#include <string_view>

#include <fmt/format.h>
#include <gnutls/gnutls.h>
#include <gnutls/x509.h>
#include <sys/stat.h>
#include <unistd.h>

#include "common/base/error.h"
#include "common/base/files/atomic_file.h"
#include "common/base/files/folder.h"
#include "common/wire/random_id.h"
#include "host_app/web/web_server.h"

namespace vantage {
namespace {

constexpr std::size_t most_pem_bytes = 1 << 16;

struct CertificateEnd {
    void operator()(gnutls_x509_crt_t certificate) const { gnutls_x509_crt_deinit(certificate); }
};
struct KeyEnd {
    void operator()(gnutls_x509_privkey_t key) const { gnutls_x509_privkey_deinit(key); }
};
using CertificateHandle = std::unique_ptr<std::remove_pointer_t<gnutls_x509_crt_t>, CertificateEnd>;
using KeyHandle = std::unique_ptr<std::remove_pointer_t<gnutls_x509_privkey_t>, KeyEnd>;

void require_tls(int code, const std::string& what) {
    if (code < 0) fail("{}: {}", what, gnutls_strerror(code));
}

CertificateHandle new_certificate() {
    gnutls_x509_crt_t certificate = nullptr;
    require_tls(gnutls_x509_crt_init(&certificate), "no certificate can be made");
    return CertificateHandle(certificate);
}

std::string text_of(gnutls_datum_t& datum) {
    std::string text(reinterpret_cast<const char*>(datum.data), datum.size);
    gnutls_free(datum.data);
    return text;
}

std::string fingerprint_of(const std::string& pem, const std::string& file) {
    const CertificateHandle certificate = new_certificate();
    const gnutls_datum_t datum{reinterpret_cast<unsigned char*>(const_cast<char*>(pem.data())),
                               static_cast<unsigned>(pem.size())};
    require_tls(gnutls_x509_crt_import(certificate.get(), &datum, GNUTLS_X509_FMT_PEM),
                file + " is no certificate in PEM");
    std::array<unsigned char, 32> hash{};
    std::size_t size = hash.size();
    require_tls(
        gnutls_x509_crt_get_fingerprint(certificate.get(), GNUTLS_DIG_SHA256, hash.data(), &size),
        file + " has no fingerprint");
    std::string text;
    for (const unsigned char byte : hash)
        text += fmt::format("{}{:02x}", text.empty() ? "" : ":", byte);
    return text;
}

std::string own_name() {
    std::array<char, 256> name{};
    return gethostname(name.data(), name.size() - 1) == 0 && name[0] ? name.data() : "vantage";
}

WebCertificate made_certificate() {
    constexpr std::time_t ten_years_s = 10LL * 365 * 86400, an_hour_s = 3600;
    gnutls_x509_privkey_t made = nullptr;
    require_tls(gnutls_x509_privkey_init(&made), "no key can be made");
    const KeyHandle key(made);
    require_tls(gnutls_x509_privkey_generate(key.get(), GNUTLS_PK_ECDSA,
                                             GNUTLS_CURVE_TO_BITS(GNUTLS_ECC_CURVE_SECP256R1), 0),
                "no key can be made");
    const CertificateHandle handle = new_certificate();
    gnutls_x509_crt_t certificate = handle.get();
    const std::string name = own_name();
    const std::uint64_t serial = random_id() >> 1;
    const std::time_t now = std::time(nullptr);
    std::array<unsigned char, 8> serial_bytes{};
    for (std::size_t i = 0; i < serial_bytes.size(); ++i)
        serial_bytes[i] = static_cast<unsigned char>(serial >> (8 * (7 - i)) & 0xff);
    for (const int code :
         {gnutls_x509_crt_set_version(certificate, 3),
          gnutls_x509_crt_set_key(certificate, key.get()),
          gnutls_x509_crt_set_serial(certificate, serial_bytes.data(), serial_bytes.size()),
          gnutls_x509_crt_set_activation_time(certificate, now - an_hour_s),
          gnutls_x509_crt_set_expiration_time(certificate, now + ten_years_s),
          gnutls_x509_crt_set_dn_by_oid(certificate, GNUTLS_OID_X520_COMMON_NAME, 0, name.data(),
                                        static_cast<unsigned>(name.size())),
          gnutls_x509_crt_set_subject_alt_name(certificate, GNUTLS_SAN_DNSNAME, name.data(),
                                               static_cast<unsigned>(name.size()), GNUTLS_FSAN_SET),
          gnutls_x509_crt_set_basic_constraints(certificate, 0, -1),
          gnutls_x509_crt_sign2(certificate, certificate, key.get(), GNUTLS_DIG_SHA256, 0)})
        require_tls(code, "no certificate can be made");
    gnutls_datum_t datum{};
    require_tls(gnutls_x509_crt_export2(certificate, GNUTLS_X509_FMT_PEM, &datum),
                "no certificate can be made");
    WebCertificate pem;
    pem.certificate = text_of(datum);
    require_tls(gnutls_x509_privkey_export2(key.get(), GNUTLS_X509_FMT_PEM, &datum),
                "no key can be made");
    pem.key = text_of(datum);
    return pem;
}

}  // namespace

WebCertificate read_certificate(const std::filesystem::path& certificate,
                                const std::filesystem::path& key) {
    WebCertificate read{
        read_text_file(certificate, most_pem_bytes), read_text_file(key, most_pem_bytes), {}};
    read.fingerprint = fingerprint_of(read.certificate, certificate.string());
    if (read.key.find("PRIVATE KEY-----") == std::string::npos)
        fail("{} is no private key in PEM", key.string());
    return read;
}

WebCertificate own_certificate(const std::filesystem::path& folder) {
    const std::filesystem::path certificate = folder / "web.crt", key = folder / "web.key";
    if (std::filesystem::exists(certificate) && std::filesystem::exists(key))
        return read_certificate(certificate, key);
    make_folder(folder);
    const WebCertificate made = made_certificate();
    const mode_t before = ::umask(077);
    try {
        write_text_atomically(key, made.key);
    } catch (const Error&) {
        ::umask(before);
        throw;
    }
    ::umask(before);
    write_text_atomically(certificate, made.certificate);
    return read_certificate(certificate, key);
}

}  // namespace vantage
