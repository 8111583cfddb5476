#include "rehearsal/modal_motion.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "sender/job/line_words.hpp"

namespace kerf::rehearsal {
namespace {

const PlacedWord* motion_word(const LineText& line) {
  const auto found = std::ranges::find_if(line.words(), [](const PlacedWord& word) {
    return job::sets_motion({.letter = word.letter, .digits = word.digits});
  });
  return found == line.words().end() ? nullptr : &*found;
}

}  // namespace

void ModalMotion::note(const LineText& line) {
  if (const PlacedWord* const word = motion_word(line)) word_ = word->value;
}

void ModalMotion::say(LineText& line, int word) {
  const PlacedWord* const said = motion_word(line);
  if (said != nullptr) {
    // "G02" becomes "G03".
    const bool has_zero = said->digits.starts_with('0') && said->digits.size() > 1;
    if (said->value != word) line.replace(*said, (has_zero ? "G0" : "G") + std::to_string(word));
  } else if (word_ != word) {
    const auto first = std::ranges::find_if(line.words(), [](const PlacedWord& other) { return other.letter != 'N'; });
    if (first != line.words().end()) line.insert_before(*first, "G" + std::to_string(word));
  }
  word_ = word;
}

void put_words(LineText& line, std::string_view letters, std::vector<std::pair<char, std::string>> words) {
  std::vector<const PlacedWord*> places;
  for (const PlacedWord& word : line.words()) {
    if (letters.contains(word.letter)) places.push_back(&word);
  }
  const PlacedWord* const last = places.empty() ? nullptr : places.back();
  std::erase_if(places, [&](const PlacedWord* place) {
    const auto own = std::ranges::find(words, place->letter, &std::pair<char, std::string>::first);
    if (own == words.end()) return false;
    if (own->second != place->digits) line.replace(*place, own->first + own->second);
    words.erase(own);
    return true;
  });
  for (std::size_t at = 0; at < places.size(); ++at) {
    if (at < words.size()) {
      line.replace(*places[at], words[at].first + words[at].second);
    } else {
      line.erase(*places[at]);
    }
  }
  for (std::size_t at = places.size(); at < words.size(); ++at) {
    const std::string text = words[at].first + words[at].second;
    if (last != nullptr) {
      line.insert_after(*last, text);
    } else {
      line.append(text);
    }
  }
}

}  // namespace kerf::rehearsal
