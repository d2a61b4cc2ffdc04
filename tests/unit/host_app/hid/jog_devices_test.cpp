#include "host_app/control/hid/jog_devices.h"

#include <gtest/gtest.h>

#include "host_app/control/hid/jog_mapper.h"
#include "tests/unit/host_app/hid/scripted_port.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;
using Kind = DeckEvent::Kind;

class JogDevicesTest : public testing::Test {
  protected:
    static std::shared_ptr<ScriptedDevice> xpress(const char* path = "/dev/hidraw0") {
        return std::make_shared<ScriptedDevice>(
            JogPlace{.path = path, .id = {0x0b33, 0x0020}, .name = "ShuttleXpress", .serial = {}});
    }
    std::unique_ptr<JogDevices> deck(bool raw = false) {
        return std::make_unique<JogDevices>(
            sockets_.bus(), load_wheel_profiles(),
            JogDevices::Options{.raw_reports = raw, .look_every = 5ms});
    }
    /// The next event; one of kind `report` without a profile if none came.
    static DeckEvent next(JogDevices& deck) {
        return deck.next(10s).value_or(DeckEvent{Kind::report, "nothing came", {}, {}, {}, {}});
    }
    /// The only device once the deck's looks show it so: events run ahead of them.
    template <class Condition>
    static DeckDevice device_once(JogDevices& deck, Condition condition) {
        std::vector<DeckDevice> devices;
        for (int i = 0; i < 2000; ++i) {
            devices = deck.devices();
            if (devices.size() == 1 && condition(devices[0])) return devices[0];
            std::this_thread::sleep_for(5ms);
        }
        ADD_FAILURE() << "of " << devices.size() << " devices none became as it should";
        return {};
    }

    ScriptedSockets sockets_;
};

TEST_F(JogDevicesTest, ReadsWhatIsPluggedInAtTheStart) {
    const auto device = xpress();
    sockets_.plug(device);
    const auto deck = this->deck();
    EXPECT_EQ(next(*deck).kind, Kind::plugged);
    device->send({0, 10, 0, 0, 0});
    device->send({0, 12, 0, 0, 0});
    const DeckEvent event = next(*deck);
    EXPECT_EQ(event.kind, Kind::control);
    EXPECT_EQ(event.event, (JogEvent{JogKind::step, "jog", 2}));
    EXPECT_EQ(event.profile->name, "Contour ShuttleXpress");
}

TEST_F(JogDevicesTest, NoticesPluggingInAndOutAndStartsTheCounterAnew) {
    const auto deck = this->deck();
    auto device = xpress();
    sockets_.plug(device);
    EXPECT_EQ(next(*deck).kind, Kind::plugged);
    device->send({0, 10, 0, 0, 0});
    device->send({0, 11, 0, 0, 0});
    EXPECT_EQ(next(*deck).event.value, 1);
    sockets_.unplug(device);
    EXPECT_EQ(next(*deck).kind, Kind::lost);
    device = xpress();
    sockets_.plug(device);
    EXPECT_EQ(next(*deck).kind, Kind::plugged);
    device->send({0, 200, 0, 0, 0});
    device->send({0, 199, 0, 0, 0});
    EXPECT_EQ(next(*deck).event.value, -1) << "and not 188 at once";
}

TEST_F(JogDevicesTest, ReadsSeveralWheelsAtOnce) {
    const auto first = xpress("/dev/hidraw0"), second = xpress("/dev/hidraw1");
    sockets_.plug(first);
    sockets_.plug(second);
    const auto deck = this->deck();
    next(*deck);
    next(*deck);
    second->send({3, 0, 0, 0, 0});
    EXPECT_EQ(next(*deck).path, "/dev/hidraw1");
    first->send({3, 0, 0, 0, 0});
    EXPECT_EQ(next(*deck).path, "/dev/hidraw0");
}

TEST_F(JogDevicesTest, KeepsTryingADeviceThatMayNotBeOpenedAndTellsWhy) {
    const auto device = xpress();
    device->refusal = "it may not be opened";
    sockets_.plug(device);
    const auto deck = this->deck();
    const DeckDevice refused = device_once(*deck, [](const auto& d) { return !d.fault.empty(); });
    EXPECT_EQ(refused.fault, "it may not be opened");
    EXPECT_FALSE(refused.usable);
    EXPECT_EQ(refused.model, "Contour ShuttleXpress");
    sockets_.allow(device);
    EXPECT_EQ(next(*deck).kind, Kind::plugged);
    EXPECT_EQ(device_once(*deck, [](const auto& d) { return d.usable; }).fault, "");
}

TEST_F(JogDevicesTest, CountsReportsThatAreNone) {
    const auto device = xpress();
    sockets_.plug(device);
    const auto deck = this->deck();
    next(*deck);
    device->send({1, 2, 3});
    const DeckEvent event = next(*deck);
    EXPECT_EQ(event.kind, Kind::unread);
    EXPECT_EQ(event.report, (Bytes{1, 2, 3}));
    EXPECT_EQ(device_once(*deck, [](const auto& d) { return d.unread > 0; }).unread, 1u);
}

TEST_F(JogDevicesTest, ShowsRawReportsWhereTheyAreAskedFor) {
    const auto device = xpress();
    sockets_.plug(device);
    const auto deck = this->deck(true);
    next(*deck);
    device->send({7, 0, 0, 0, 0});
    EXPECT_EQ(next(*deck).kind, Kind::report);
    EXPECT_EQ(next(*deck).kind, Kind::control);
}

TEST_F(JogDevicesTest, LeavesOtherDevicesAlone) {
    sockets_.plug(std::make_shared<ScriptedDevice>(JogPlace{
        .path = "/dev/hidraw7", .id = {0x046d, 0xc31c}, .name = "Keyboard", .serial = {}}));
    const auto device = xpress();
    device->place.interface_number = 1;
    sockets_.plug(device);
    const auto deck = this->deck();
    EXPECT_FALSE(deck->next(60ms));
    EXPECT_TRUE(deck->devices().empty());
}

TEST_F(JogDevicesTest, LooksOnAfterAFaultOfTheBusAndReadsWhatIsOpen) {
    const auto first = xpress();
    sockets_.plug(first);
    const auto deck = this->deck();
    EXPECT_EQ(next(*deck).kind, Kind::plugged);
    sockets_.stop_listing("the bus broke");
    for (int i = 0; i < 2000 && sockets_.failed_listings() < 2; ++i)
        std::this_thread::sleep_for(5ms);
    ASSERT_GE(sockets_.failed_listings(), 2);
    first->send({0, 10, 0, 0, 0});
    first->send({0, 12, 0, 0, 0});
    EXPECT_EQ(next(*deck).kind, Kind::control);
    sockets_.plug(xpress("/dev/hidraw1"));
    sockets_.list_again();
    const DeckEvent event = next(*deck);
    EXPECT_EQ(event.kind, Kind::plugged);
    EXPECT_EQ(event.path, "/dev/hidraw1");
}

TEST_F(JogDevicesTest, AHeldRingLetsGoWhenItsWheelIsPulledOut) {
    const auto device = xpress();
    sockets_.plug(device);
    const auto deck = this->deck();
    JogMapper mapper;
    mapper.take(next(*deck));
    device->send({7, 0, 0, 0, 0});
    mapper.take(next(*deck));
    EXPECT_EQ(mapper.input(0.5).shuttle_s, 1.0) << "0.5 s at 2x";
    sockets_.unplug(device);
    mapper.take(next(*deck));
    EXPECT_EQ(mapper.input(0.5).shuttle_s, 0) << "the camera holds";
}

TEST(ReadableJogs, TakeANodeOnceHoweverManyCollectionsItHas) {
    const std::vector<WheelProfile> profiles = load_wheel_profiles();
    JogPlace place{.path = "/dev/hidraw0", .id = {0x046d, 0xc626}, .name = {}, .serial = {}};
    place.usage_page = 1;
    place.usage = 8;
    JogPlace other = place;
    other.usage = 0x3a;
    EXPECT_EQ(readable_jogs({other, place, place}, profiles).size(), 1u);
    EXPECT_EQ(readable_jogs({other, place}, profiles)[0].model, "3Dconnexion SpaceNavigator");
}

}  // namespace
}  // namespace vantage
