#include <memory>
#include <optional>

#include <alsa/asoundlib.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "host_app/control/ports/control_port.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

/// Somebody else's surface at the same sequencer: pads that send and are lit.
class Pads {
  public:
    Pads() {
        snd_seq_t* opened = nullptr;
        if (snd_seq_open(&opened, "default", SND_SEQ_OPEN_DUPLEX, SND_SEQ_NONBLOCK) < 0) return;
        sequencer_.reset(opened);
        snd_seq_set_client_name(opened, "Workshop Pads");
        port_ = snd_seq_create_simple_port(
            opened, "pads",
            SND_SEQ_PORT_CAP_READ | SND_SEQ_PORT_CAP_SUBS_READ | SND_SEQ_PORT_CAP_WRITE |
                SND_SEQ_PORT_CAP_SUBS_WRITE,
            SND_SEQ_PORT_TYPE_MIDI_GENERIC | SND_SEQ_PORT_TYPE_APPLICATION);
    }
    void note(unsigned char number, unsigned char velocity) {
        snd_seq_event_t event = to_whoever_listens();
        snd_seq_ev_set_noteon(&event, 0, number, velocity);
        snd_seq_event_output_direct(sequencer_.get(), &event);
    }
    void controller(unsigned number, int value) {
        snd_seq_event_t event = to_whoever_listens();
        snd_seq_ev_set_controller(&event, 0, number, value);
        snd_seq_event_output_direct(sequencer_.get(), &event);
    }
    /// How a pad is lit by what came since the last call; nothing: it was not told.
    std::optional<int> lit(int number) {
        std::optional<int> velocity;
        for (snd_seq_event_t* came = nullptr; snd_seq_event_input(sequencer_.get(), &came) >= 0;)
            if (came && came->type == SND_SEQ_EVENT_NOTEON && came->data.note.note == number)
                velocity = came->data.note.velocity;
        return velocity;
    }

  private:
    struct Close {
        void operator()(snd_seq_t* sequencer) const { snd_seq_close(sequencer); }
    };
    snd_seq_event_t to_whoever_listens() const {
        snd_seq_event_t event;
        snd_seq_ev_clear(&event);
        snd_seq_ev_set_source(&event, static_cast<unsigned char>(port_));
        snd_seq_ev_set_subs(&event);
        snd_seq_ev_set_direct(&event);
        return event;
    }
    std::unique_ptr<snd_seq_t, Close> sequencer_;
    int port_ = -1;
};

class MidiPads : public testing::Test {
  protected:
    void SetUp() override {
        if (access("/dev/snd/seq", R_OK | W_OK) != 0)
            GTEST_SKIP() << "SKIPPED: /dev/snd/seq is not there";
    }
    static void serve(ControlPort& port) {
        for (int i = 0; i < 20; ++i) port.serve(20ms);
    }
    OperatorInputBox operator_input_;
    TrackedCamera tracked_;
    Tally tally_;
    LampBoard lamps_;
    LtcBoard ltc_;
    ControlBench bench_{operator_input_, tracked_, tally_, lamps_, ltc_};
};

TEST_F(MidiPads, SteerAndAreLitWheneverTheyArePluggedIn) {
    auto early = std::make_unique<Pads>();
    const auto port = open_port("midi://workshop", bench_);
    serve(*port);
    EXPECT_EQ(early->lit(45), 0);
    early->note(45, 100);
    serve(*port);
    EXPECT_TRUE(operator_input_.take().input.find<command::ToggleHold>());
    ShowLamps shown;
    shown.hold = true;
    lamps_.put(shown);
    serve(*port);
    EXPECT_EQ(early->lit(45), 127);

    early.reset();
    serve(*port);
    Pads late;
    serve(*port);
    EXPECT_EQ(late.lit(45), 127) << "a surface that comes is told all lamps";
    late.controller(17, 3);
    serve(*port);
    EXPECT_GT(operator_input_.take().input.orbit_azimuth_rad, 0);
    late.controller(17, 300);
    late.note(1, 1);
    serve(*port);
    EXPECT_EQ(port->stats().malformed, 1u) << port->stats().last_refusal;
    EXPECT_EQ(port->stats().unknown, 1u);
    EXPECT_FALSE(operator_input_.take().since);
}

TEST_F(MidiPads, OfAnotherNameAreNotHeard) {
    Pads pads;
    const auto port = open_port("midi://another", bench_);
    serve(*port);
    pads.note(45, 100);
    serve(*port);
    EXPECT_EQ(port->stats().obeyed, 0u);
    EXPECT_EQ(port->stats().malformed, 0u) << port->stats().last_refusal;
    EXPECT_FALSE(operator_input_.take().since);
}

}  // namespace
}  // namespace vantage
