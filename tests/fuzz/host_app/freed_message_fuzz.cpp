#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>

#include "host_app/control/tracking/freed_message.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace vantage;
    const std::span bytes = std::as_bytes(std::span(data, size));
    const auto check = [](const std::optional<FreedCamera>& camera) {
        if (!camera) return;
        const Eigen::Matrix3d turn = camera->world_from_camera.linear();
        if (!((turn * turn.transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-9)) std::abort();
        // What has been understood goes out as it came in.
        const auto again = decode_freed(encode_freed(*camera));
        if (!again || again->zoom != camera->zoom || again->focus != camera->focus) std::abort();
    };
    check(decode_freed(bytes));
    // With a right checksum and type, so that the rest is looked at too.
    if (bytes.size() < freed_bytes) return 0;
    std::array<std::byte, freed_bytes> mended{};
    std::copy_n(bytes.begin(), freed_bytes, mended.begin());
    mended[0] = std::byte{0xd1};
    unsigned sum = 0x40;
    for (std::size_t i = 0; i + 1 < freed_bytes; ++i) sum -= std::to_integer<unsigned>(mended[i]);
    mended.back() = static_cast<std::byte>(sum & 0xff);
    check(decode_freed(mended));
    return 0;
}
