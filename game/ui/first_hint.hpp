#pragma once

namespace handhold {

// Says what to do next until somebody who plays for the first time has gripped and pulled once.
class FirstHint {
  public:
    // What happened in a frame.
    struct Seen {
        bool can_reach = false;  // the mark is green
        bool grips = false;      // a hand grips something on which it can pull
        double moved_m = 0.0;    // way of the play space in this frame
    };
    // Call once a frame.
    void advance(const Seen& seen, double dt_s);
    // One line; empty: there is nothing more to say.
    const char* text() const;

  private:
    enum class Step { look, press, pull, again, gone };

    Step step_ = Step::look;
    double pulled_m_ = 0.0;
    double again_s_ = 0.0;
};

}  // namespace handhold
