#include "sender/streaming/ledger.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace kerf::streaming {

std::uint64_t Ledger::enter(OwedLine line) {
  line.serial = ++entered_;
  bytes_ += line.bytes;
  owed_.push_back(std::move(line));
  return entered_;
}

std::optional<OwedLine> Ledger::settle() {
  if (owed_.empty()) return std::nullopt;
  OwedLine line = std::move(owed_.front());
  owed_.pop_front();
  bytes_ -= line.bytes;
  ++settled_;
  return line;
}

std::vector<OwedLine> Ledger::strike_out() {
  std::vector<OwedLine> lost{std::make_move_iterator(owed_.begin()), std::make_move_iterator(owed_.end())};
  owed_.clear();
  bytes_ = 0;
  struck_out_ += lost.size();
  return lost;
}

std::vector<OwedLine> Ledger::strike_out_before(Purpose purpose) {
  std::vector<OwedLine> lost;
  if (!owes(purpose)) return lost;
  while (owed_.front().purpose != purpose) {
    bytes_ -= owed_.front().bytes;
    lost.push_back(std::move(owed_.front()));
    owed_.pop_front();
  }
  struck_out_ += lost.size();
  return lost;
}

bool Ledger::owes(Purpose purpose) const {
  return std::ranges::any_of(owed_, [purpose](const OwedLine& line) { return line.purpose == purpose; });
}

}  // namespace kerf::streaming
