#include "daemon/live_clients.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace kerf::daemon {
namespace {

/// A client that has not taken so much yet gets no more patches, and the whole state when it has.
constexpr std::size_t kMostWaiting = std::size_t{1} << 20U;
/// Nobody types so fast: renewals of a jog are 20 a second.
constexpr double kMostFramesPerSecond = 200;
constexpr double kMostFramesAtOnce = 400;

}  // namespace

class LiveClients::Client final : public io::web::ChannelUser {
 public:
  Client(LiveClients& owner, io::web::Channel& channel, std::string name)
      : owner_(owner), channel_(channel), name_(std::move(name)) {}

  ~Client() override {
    for (const auto& [id, station] : owner_.park_.stations()) station->release_jog(name_);
    owner_.leave(*this);
  }

  void greet(std::optional<std::uint64_t> from) {
    const StateFeed& feed = owner_.park_.feed();
    send({{"type", "hello"}, {"client", name_}, {"clock_s", owner_.park_.clock_s()}, {"number", feed.number()}});
    const auto patches = from ? feed.since(*from) : std::nullopt;
    if (!patches) return channel_.send(feed.snapshot(owner_.park_.clock_s()));
    for (const Frame& patch : *patches) channel_.send(patch);
  }

  void on_published(const Frame& patch) {
    needs_snapshot_ = needs_snapshot_ || channel_.waiting_bytes() > kMostWaiting;
    if (!needs_snapshot_) channel_.send(patch);
  }

  void on_traffic(const std::string& machine) {
    const auto watched = watched_.find(machine);
    const Station* const station = owner_.park_.find(machine);
    if (watched == watched_.end() || station == nullptr || needs_snapshot_) return;
    Json lines = Json::array();
    for (const TrafficLine& line : station->traffic().lines()) {
      if (line.number > watched->second) lines.push_back(io::to_json(line));
    }
    watched->second = station->traffic().number();
    if (!lines.empty()) send({{"type", "traffic"}, {"machine", machine}, {"lines", std::move(lines)}});
  }

  void on_drained() override {
    if (!std::exchange(needs_snapshot_, false)) return;
    channel_.send(owner_.park_.feed().snapshot(owner_.park_.clock_s()));
  }

  void on_text(std::string_view text) override {
    if (is_too_fast()) return answer("", {Outcome::Refused, "TooMany", "These are too many messages."});
    Json frame = Json::parse(text, nullptr, false);
    if (!frame.is_object() || !frame.contains("type") || !frame["type"].is_string()) {
      return answer("", {Outcome::Invalid, "NotAnObject", "A message is an object with a type."});
    }
    const std::string type = frame["type"].get<std::string>();
    frame.erase("type");
    const std::string machine = frame.value("machine", Json()).is_string() ? frame["machine"].get<std::string>() : "";
    frame.erase("machine");
    if (type == "command") return obey(machine, std::move(frame));
    if (type == "watch") return watch(frame);
    Station* const station = owner_.park_.find(machine);
    if (station == nullptr)
      return answer(key_of(frame), {Outcome::Invalid, "NoSuchMachine", "There is no such machine."});
    if (type == "jog") return press(*station, std::move(frame));
    if (type == "jog-renew") return station->renew_jog(name_);
    if (type == "jog-release") return station->release_jog(name_);
    answer(key_of(frame), {Outcome::Invalid, "NoSuchType", "This type of message is not known."});
  }

 private:
  static std::string key_of(const Json& frame) {
    const auto key = frame.find("key");
    return key != frame.end() && key->is_string() ? key->get<std::string>() : std::string{};
  }

  /// A bucket that fills with time.
  bool is_too_fast() {
    const double now = owner_.park_.clock_s();
    frames_ = std::min(kMostFramesAtOnce, frames_ + (now - counted_at_s_) * kMostFramesPerSecond);
    counted_at_s_ = now;
    if (frames_ < 1) return true;
    frames_ -= 1;
    return false;
  }

  void obey(const std::string& machine, Json frame) {
    std::string key = key_of(frame);
    answer(key, owner_.answers_.obey(machine, std::move(frame), "page"));
  }

  void press(Station& station, Json frame) {
    const std::string key = key_of(frame);
    frame.erase("key");
    const auto wish = io::from_json<JogPress>(frame);
    if (!wish) return answer(key, {Outcome::Invalid, "BadJog", wish.error().where + " " + wish.error().what + "."});
    answer(key, station.press_jog(name_, *wish));
  }

  void watch(const Json& frame) {
    const auto wanted = frame.find("traffic");
    if (wanted == frame.end() || !wanted->is_array()) return;
    std::map<std::string, std::uint64_t> watched;
    for (const Json& machine : *wanted) {
      if (!machine.is_string()) continue;
      const auto known = watched_.find(machine.get<std::string>());
      watched[machine.get<std::string>()] = known == watched_.end() ? 0 : known->second;
    }
    watched_ = std::move(watched);
    for (const auto& [machine, number] : std::map(watched_)) on_traffic(machine);
  }

  void answer(const std::string& key, const CommandAnswer& answer) {
    Json frame = {{"type", "answer"}, {"key", key}};
    frame.update(io::to_json(answer));
    send(frame);
  }
  void send(const Json& frame) { channel_.send(frame_of(frame)); }

  LiveClients& owner_;
  io::web::Channel& channel_;
  const std::string name_;
  bool needs_snapshot_ = false;
  double frames_ = kMostFramesAtOnce;
  double counted_at_s_ = 0;
  /// By machine, the number of the last line that was sent.
  std::map<std::string, std::uint64_t> watched_;
};

std::unique_ptr<io::web::ChannelUser> LiveClients::open(io::web::Channel& channel, std::optional<std::uint64_t> from) {
  auto client = std::make_unique<Client>(*this, channel, "c" + std::to_string(++number_));
  client->greet(from);
  clients_.insert(client.get());
  park_.set_watched(true);
  return client;
}

void LiveClients::leave(Client& client) {
  clients_.erase(&client);
  park_.set_watched(!clients_.empty());
}

void LiveClients::on_published(const Frame& patch) {
  for (Client* const client : clients_) client->on_published(patch);
}

void LiveClients::on_traffic(const std::string& machine) {
  for (Client* const client : clients_) client->on_traffic(machine);
}

}  // namespace kerf::daemon
