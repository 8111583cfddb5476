#pragma once
// A program on its way into the library.

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "daemon/api_replies.hpp"
#include "daemon/program_library.hpp"

namespace kerf::daemon {

class ProgramUpload final : public io::web::BodySink {
 public:
  ProgramUpload(ProgramLibrary& library, std::unique_ptr<ProgramLibrary::Incoming> incoming)
      : library_(library), incoming_(std::move(incoming)) {}

  [[nodiscard]] std::optional<io::web::HttpReply> append(std::string_view bytes) override {
    if (auto kept = incoming_->append(bytes); !kept) return error_reply(507, "NoRoom", kept.error());
    return std::nullopt;
  }

  void finish(io::web::Answer answer) override {
    incoming_->finish([this_library = &library_, answer](const ProgramLibrary::Added& added) {
      if (!added) return answer(error_reply(422, "NotAProgram", added.error()));
      io::Json reply = {{"id", *added}};
      reply.update(io::to_json(this_library->programs().at(*added)));
      answer(json_reply(reply, 201));
    });
  }

 private:
  ProgramLibrary& library_;
  std::unique_ptr<ProgramLibrary::Incoming> incoming_;
};

}  // namespace kerf::daemon
