#pragma once
// A WebSocket as a link, at both ends. The only header of Boost.Beast's only file.

#include <memory>
#include <string_view>

#include <boost/asio/ip/tcp.hpp>

#include "io/byte_link.hpp"
#include "io/machine_url.hpp"

namespace kerf::io {

/// Our end of a connection to a controller; start() shakes hands. A peer that is no WebSocket server is
/// `errc::protocol_error`.
///
/// Realtime bytes travel in frames of their own, and everything in binary frames, because 0x80 and above is no UTF-8.
/// No pings: grblHAL's websocketd.c answers one by overwriting the next frame, and status questions keep a link alive.
[[nodiscard]] std::shared_ptr<ByteLink> make_websocket_client(boost::asio::ip::tcp::socket socket,
                                                              const WebSocketAddress& address,
                                                              ByteLink::Callbacks callbacks);

/// A controller's end, as grblHAL serves it (websocketd.c): takes the first subprotocol that is offered, answers in
/// binary frames to "arduino" and in text frames to others, and gives up a client that answers no pings.
[[nodiscard]] std::shared_ptr<ByteLink> make_websocket_server(boost::asio::ip::tcp::socket socket,
                                                              ByteLink::Callbacks callbacks);

/// A text frame that is meant for FluidNC's own web pages (WSChannel.cpp), and no word of the machine.
[[nodiscard]] bool is_web_page_talk(std::string_view text);

}  // namespace kerf::io
