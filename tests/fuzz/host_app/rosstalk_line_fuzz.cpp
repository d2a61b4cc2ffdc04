#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "host_app/control/ports/messages/rosstalk.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace vantage;
    static const RossTalkMap map = RossTalkMap::load({});
    LineSplitter lines;
    lines.take({reinterpret_cast<const char*>(data), size});
    while (const auto line = lines.next()) {
        if (line->find("\r\n") != std::string::npos) std::abort();
        const RossTalkLine said = parse_rosstalk(*line);
        if (said.order && (said.order->first < 0 || said.order->second < 0)) std::abort();
        if (said.order) (void)map.find(*said.order);
    }
    return 0;
}
