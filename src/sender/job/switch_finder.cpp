#include "sender/job/switch_finder.hpp"

namespace kerf::job {
namespace {

/// A switch may be met at speed, by a machine that is where nobody thinks: it has overrun by then.
constexpr int kMostTimesBack = 10;
constexpr int kMostReturns = 5;

}  // namespace

SwitchFinder::SwitchFinder(const SwitchSearch& search, std::int64_t at, bool is_closed)
    : search_(search), knows_open_(!is_closed), open_at_(at), target_(at) {
  if (is_closed) {
    go_back();
  } else {
    go_forward();
  }
}

SwitchFinder::Verdict SwitchFinder::on_stand(bool is_closed) {
  switch (phase_) {
    case Phase::Forward:
      if (!is_closed) {
        open_at_ = target_;
        go_forward();
      } else if (level_ + 1 < search_.moves.size()) {
        times_back_ = 0;
        go_back();
      } else {
        found_ = target_;
        end(Verdict::Found);
      }
      break;
    case Phase::Back:
      if (is_closed || (knows_open_ && (target_ - open_at_) * search_.direction >= 0)) {
        go_back();
      } else if (!knows_open_) {
        knows_open_ = true;
        open_at_ = target_;
        go_forward();
      } else {
        phase_ = Phase::Return;
        target_ = open_at_;
      }
      break;
    case Phase::Return:
      if (!is_closed) {
        ++level_;
        go_forward();
      } else if (++returns_ > kMostReturns) {
        end(Verdict::Unsteady);
      } else {
        open_at_ -= search_.direction * search_.moves.at(level_);
        times_back_ = 0;
        go_back();
      }
      break;
  }
  return verdict_;
}

void SwitchFinder::go_forward() {
  phase_ = Phase::Forward;
  target_ = open_at_ + search_.direction * search_.moves.at(level_);
  if ((target_ - search_.farthest) * search_.direction > 0) end(Verdict::NotFound);
}

void SwitchFinder::go_back() {
  phase_ = Phase::Back;
  target_ -= search_.direction * search_.back_off;
  if (++times_back_ > kMostTimesBack) end(Verdict::StaysShut);
}

}  // namespace kerf::job
