#include "tests/hil/usb_camera/uvc_descriptors.h"

namespace vantage::usb {
namespace {

// USB 2.0, 9.4 and USB Video Class 1.0, appendix A.
enum : std::uint8_t {
    device = 1,
    configuration = 2,
    string = 3,
    interface = 4,
    endpoint = 5,
    interface_association = 11,
    class_interface = 0x24
};
constexpr std::uint8_t video_class = 0x0e, control_subclass = 1, streaming_subclass = 2;
constexpr std::uint8_t camera_terminal = 1, output_terminal = 3;
constexpr std::uint32_t ticks_per_second = 10'000'000;

/// A descriptor: its length, which is filled in, its type, and pairs of (bytes, value).
struct Field {
    int bytes;
    std::uint32_t value;
};
Bytes describe(std::uint8_t type, const std::vector<Field>& fields) {
    Bytes bytes{0, type};
    for (const Field& field : fields) put(bytes, field.bytes, field.value);
    bytes[0] = static_cast<std::uint8_t>(bytes.size());
    return bytes;
}

Bytes describe_interface(std::uint8_t number, std::uint8_t endpoints, std::uint8_t subclass) {
    return describe(
        interface,
        {{1, number}, {1, 0}, {1, endpoints}, {1, video_class}, {1, subclass}, {1, 0}, {1, 2}});
}

Bytes control_interface() {
    const Bytes camera = describe(class_interface, {{1, 2},
                                                    {1, camera_terminal},
                                                    {2, 0x0201},
                                                    {1, 0},
                                                    {1, 0},
                                                    {2, 0},
                                                    {2, 0},
                                                    {2, 0},
                                                    {1, 2},
                                                    {2, 0}});
    const Bytes output =
        describe(class_interface,
                 {{1, 3}, {1, output_terminal}, {2, 0x0101}, {1, 0}, {1, camera_terminal}, {1, 0}});
    constexpr std::uint32_t header_bytes = 13, clock_hz = 48'000'000;
    const auto total = static_cast<std::uint32_t>(header_bytes + camera.size() + output.size());
    Bytes all =
        describe(class_interface, {{1, 1}, {2, 0x0100}, {2, total}, {4, clock_hz}, {1, 1}, {1, 1}});
    append(all, camera);
    append(all, output);
    return all;
}

Bytes streaming_interface(const CameraMode& mode) {
    constexpr std::uint8_t input_header = 1, format_uncompressed = 4, frame_uncompressed = 5,
                           colour_matching = 0x0d;
    Bytes format = describe(class_interface, {{1, format_uncompressed}, {1, 1}, {1, 1}});
    append(format, {'Y', 'U', 'Y', '2', 0, 0, 0x10, 0, 0x80, 0, 0, 0xaa, 0, 0x38, 0x9b, 0x71});
    append(format, {16, 1, 0, 0, 0, 0});
    format[0] = static_cast<std::uint8_t>(format.size());
    const auto rate = static_cast<std::uint32_t>(mode.rate_hz);
    const std::uint32_t interval = ticks_per_second / rate, bits = mode.frame_bytes() * 8 * rate;
    const Bytes frame = describe(class_interface, {{1, frame_uncompressed},
                                                   {1, 1},
                                                   {1, 0},
                                                   {2, static_cast<std::uint32_t>(mode.width_px)},
                                                   {2, static_cast<std::uint32_t>(mode.height_px)},
                                                   {4, bits},
                                                   {4, bits},
                                                   {4, mode.frame_bytes()},
                                                   {4, interval},
                                                   {1, 1},
                                                   {4, interval}});
    const Bytes matching =
        describe(class_interface, {{1, colour_matching}, {1, 1}, {1, 1}, {1, 4}});
    constexpr std::uint32_t header_bytes = 14;
    const auto total =
        static_cast<std::uint32_t>(header_bytes + format.size() + frame.size() + matching.size());
    Bytes all = describe(class_interface, {{1, input_header},
                                           {1, 1},
                                           {2, total},
                                           {1, stream_endpoint},
                                           {1, 0},
                                           {1, output_terminal},
                                           {1, 0},
                                           {1, 0},
                                           {1, 0},
                                           {1, 1},
                                           {1, 0}});
    append(all, format);
    append(all, frame);
    append(all, matching);
    return all;
}

}  // namespace

void put(Bytes& bytes, int count, std::uint32_t value) {
    for (int i = 0; i < count; ++i) bytes.push_back(static_cast<std::uint8_t>(value >> 8 * i));
}

void append(Bytes& bytes, const Bytes& more) {
    bytes.insert(bytes.end(), more.begin(), more.end());
}

Bytes device_descriptor() {
    return describe(device, {{2, 0x0200},
                             {1, 0xef},
                             {1, 2},
                             {1, 1},
                             {1, 64},
                             {2, vendor_id},
                             {2, product_id},
                             {2, 0x0100},
                             {1, 1},
                             {1, 2},
                             {1, 3},
                             {1, 1}});
}

Bytes configuration_descriptor(const CameraMode& mode) {
    Bytes inner =
        describe(interface_association, {{1, 0}, {1, 2}, {1, video_class}, {1, 3}, {1, 0}, {1, 2}});
    append(inner, describe_interface(0, 0, control_subclass));
    append(inner, control_interface());
    append(inner, describe_interface(1, 1, streaming_subclass));
    append(inner, streaming_interface(mode));
    append(inner, describe(endpoint, {{1, stream_endpoint}, {1, 2}, {2, packet_bytes}, {1, 0}}));
    constexpr std::uint32_t own_bytes = 9;
    Bytes all = describe(configuration, {{2, static_cast<std::uint32_t>(own_bytes + inner.size())},
                                         {1, 2},
                                         {1, 1},
                                         {1, 0},
                                         {1, 0x80},
                                         {1, 250}});
    append(all, inner);
    return all;
}

Bytes string_descriptor(int index, const std::string& serial) {
    if (index == 0) return {4, string, 0x09, 0x04};
    const std::string text = index == 1 ? "Vantage" : index == 2 ? "Test Camera " + serial : serial;
    Bytes bytes{static_cast<std::uint8_t>(2 + 2 * text.size()), string};
    for (const char c : text) put(bytes, 2, static_cast<std::uint8_t>(c));
    return bytes;
}

Bytes probe_control(const CameraMode& mode) {
    Bytes bytes;
    put(bytes, 2, 1);
    put(bytes, 1, 1);
    put(bytes, 1, 1);
    put(bytes, 4, ticks_per_second / static_cast<std::uint32_t>(mode.rate_hz));
    for (int i = 0; i < 5; ++i) put(bytes, 2, 0);
    put(bytes, 4, mode.frame_bytes());
    put(bytes, 4, mode.frame_bytes() + payload_header_bytes);
    return bytes;
}

}  // namespace vantage::usb
