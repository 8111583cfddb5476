// The conversation with the Avahi daemon: one browser for each kind of service, one resolver for each service found.

#include <algorithm>
#include <array>
#include <chrono>
#include <memory>
#include <string>
#include <utility>

#include <avahi-client/client.h>
#include <avahi-client/lookup.h>
#include <avahi-common/address.h>
#include <avahi-common/error.h>
#include <avahi-common/simple-watch.h>

#include "io/discovery.hpp"

namespace kerf::io {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::array<const char*, 3> kServices{"_telnet._tcp", "_websocket._tcp", "_http._tcp"};

template <auto Release>
struct Releaser {
  template <typename Object>
  void operator()(Object* object) const {
    Release(object);
  }
};
using Poll = std::unique_ptr<AvahiSimplePoll, Releaser<avahi_simple_poll_free>>;
/// Frees its browsers and resolvers.
using Client = std::unique_ptr<AvahiClient, Releaser<avahi_client_free>>;

/// What the callbacks below fill in.
struct Listening {
  AvahiClient* client = nullptr;
  std::vector<Announcement> found;
  /// Browsers that have more to tell, and services that are not resolved yet.
  int browsing = 0;
  int resolving = 0;
};

void on_resolved(AvahiServiceResolver* resolver, AvahiIfIndex, AvahiProtocol, AvahiResolverEvent event,
                 const char* name, const char* type, const char*, const char* host, const AvahiAddress* address,
                 std::uint16_t port, AvahiStringList* texts, AvahiLookupResultFlags, void* owner) {
  Listening& listening = *static_cast<Listening*>(owner);
  --listening.resolving;
  if (event == AVAHI_RESOLVER_FOUND) {
    std::array<char, AVAHI_ADDRESS_STR_MAX> text{};
    avahi_address_snprint(text.data(), text.size(), address);
    Announcement announcement{
        .service = type, .name = name, .host = host, .address = text.data(), .port = port, .texts = {}};
    for (; texts != nullptr; texts = avahi_string_list_get_next(texts)) {
      announcement.texts.emplace_back(reinterpret_cast<const char*>(avahi_string_list_get_text(texts)),
                                      avahi_string_list_get_size(texts));
    }
    // One that is heard on two interfaces is still one.
    if (std::ranges::find(listening.found, announcement) == listening.found.end()) {
      listening.found.push_back(std::move(announcement));
    }
  }
  avahi_service_resolver_free(resolver);
}

void on_browsed(AvahiServiceBrowser*, AvahiIfIndex interface, AvahiProtocol protocol, AvahiBrowserEvent event,
                const char* name, const char* type, const char* domain, AvahiLookupResultFlags, void* owner) {
  Listening& listening = *static_cast<Listening*>(owner);
  if (event == AVAHI_BROWSER_ALL_FOR_NOW || event == AVAHI_BROWSER_FAILURE) --listening.browsing;
  if (event != AVAHI_BROWSER_NEW) return;
  const auto* resolver =
      avahi_service_resolver_new(listening.client, interface, protocol, name, type, domain, AVAHI_PROTO_INET,
                                 static_cast<AvahiLookupFlags>(0), &on_resolved, owner);
  if (resolver != nullptr) ++listening.resolving;
}

void on_client(AvahiClient*, AvahiClientState, void*) {}

DiscoveryError error_of(int code) {
  const bool no_daemon = code == AVAHI_ERR_NO_DAEMON || code == AVAHI_ERR_DBUS_ERROR || code == AVAHI_ERR_DISCONNECTED;
  return {.no_daemon = no_daemon, .text = avahi_strerror(code)};
}

}  // namespace

std::expected<std::vector<Announcement>, DiscoveryError> listen_to_announcements(Duration limit) {
  const auto end = Clock::now() + limit;
  const Poll poll(avahi_simple_poll_new());
  if (!poll) return std::unexpected(error_of(AVAHI_ERR_NO_MEMORY));
  Listening listening;
  int code = 0;
  const Client client(avahi_client_new(avahi_simple_poll_get(poll.get()), static_cast<AvahiClientFlags>(0), &on_client,
                                       nullptr, &code));
  if (!client) return std::unexpected(error_of(code));
  listening.client = client.get();
  for (const char* service : kServices) {
    const auto* browser = avahi_service_browser_new(client.get(), AVAHI_IF_UNSPEC, AVAHI_PROTO_INET, service, nullptr,
                                                    static_cast<AvahiLookupFlags>(0), &on_browsed, &listening);
    if (browser == nullptr) return std::unexpected(error_of(avahi_client_errno(client.get())));
    ++listening.browsing;
  }
  while (listening.browsing > 0 || listening.resolving > 0) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now());
    if (left.count() <= 0 || avahi_simple_poll_iterate(poll.get(), static_cast<int>(left.count())) != 0) break;
  }
  return std::move(listening.found);
}

}  // namespace kerf::io
