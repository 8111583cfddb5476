#pragma once
// Reading and writing of any Asio stream as a link: two queues, of which the realtime one always goes first.
// Included only by the transports and servers, because it pulls Asio in.

#include <array>
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include <boost/asio/buffer.hpp>
#include <boost/asio/error.hpp>
#include <boost/asio/write.hpp>
#include <unistd.h>

#include "io/byte_link.hpp"

namespace kerf::io {

/// Lives as long as an operation of its stream is under way; close() silences it. Loop's thread only.
template <typename Stream>
class StreamLink final : public ByteLink, public std::enable_shared_from_this<StreamLink<Stream>> {
 public:
  StreamLink(Stream stream, Callbacks callbacks)
      : stream_(std::move(stream)), callbacks_(std::make_shared<const Callbacks>(std::move(callbacks))) {}

  void start() override {
    const auto callbacks = callbacks_;
    if (callbacks->opened) callbacks->opened();
    if (callbacks_) read();
  }

  void go_on() override {
    if (callbacks_ && std::exchange(waits_for_room_, false)) read();
  }

  void close() override {
    callbacks_.reset();
    boost::system::error_code ignored;
    stream_.close(ignored);
  }

  [[nodiscard]] Stream& stream() { return stream_; }

 protected:
  void write() override {
    if (is_writing_) return;
    while (this->waiting_bytes() != 0) {
      outgoing_ = this->take_piece();
      outgoing_.erase(0, write_at_once());
      if (!outgoing_.empty()) return finish_piece();
    }
  }

 private:
  /// How many bytes of `outgoing_` the operating system took without delay. Of a fault finish_piece() hears.
  std::size_t write_at_once() {
    boost::system::error_code fault;
    if constexpr (requires { stream_.non_blocking(true, fault); }) {
      if (!stream_.non_blocking()) stream_.non_blocking(true, fault);
      return stream_.write_some(boost::asio::buffer(outgoing_), fault);
    } else {
      // Asio opens serial ports as non-blocking and has no word for it.
      const auto taken = ::write(stream_.native_handle(), outgoing_.data(), outgoing_.size());
      return taken < 0 ? 0 : static_cast<std::size_t>(taken);
    }
  }

  void finish_piece() {
    is_writing_ = true;
    boost::asio::async_write(stream_, boost::asio::buffer(outgoing_),
                             [self = this->shared_from_this()](boost::system::error_code fault, std::size_t) {
                               self->is_writing_ = false;
                               if (fault) return self->lose(fault);
                               self->write();
                             });
  }

  void read() {
    const std::size_t room = callbacks_->room ? callbacks_->room() : incoming_.size();
    waits_for_room_ = room == 0;
    if (waits_for_room_) return;
    stream_.async_read_some(boost::asio::buffer(incoming_, room),
                            [self = this->shared_from_this()](boost::system::error_code fault, std::size_t count) {
                              if (fault) return self->lose(fault);
                              const auto callbacks = self->callbacks_;  // the owner may close() in there
                              if (!callbacks) return;
                              callbacks->received(std::string_view(self->incoming_.data(), count));
                              if (self->callbacks_) self->read();
                            });
  }

  void lose(boost::system::error_code fault) {
    const auto callbacks = std::exchange(callbacks_, nullptr);
    if (!callbacks) return;
    boost::system::error_code ignored;
    stream_.close(ignored);
    callbacks->lost(fault);
  }

  Stream stream_;
  std::shared_ptr<const Callbacks> callbacks_;
  std::array<char, 4096> incoming_{};
  std::string outgoing_;
  bool is_writing_ = false;
  bool waits_for_room_ = false;
};

}  // namespace kerf::io
