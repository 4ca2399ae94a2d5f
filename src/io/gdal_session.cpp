// A handler on GDAL's per-thread stack of error handlers: errors are kept until they are reset, warnings
// until taken.
// Warnings that nobody took go to the session around.
#include "io/gdal_session.hpp"

#include <cpl_conv.h>
#include <cpl_error.h>
#include <gdal.h>

#include <algorithm>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace thalweg {

struct GdalSession::Messages {
  std::vector<std::string> errors;
  std::vector<std::string> warnings;
  bool memory_lacked = false;
  GdalSession* outer = nullptr;
};

namespace {

thread_local GdalSession* innermost = nullptr;

// A broken file can give a message a row: what is beyond these says nothing new.
constexpr std::size_t kMostMessages = 8;
// A message can hold a statement of any length, and says at its end what is wrong with it.
constexpr std::size_t kLongest = 300;

std::string one_line(const char* text) {
  std::string line(text);
  std::replace(line.begin(), line.end(), '\n', ' ');
  std::replace(line.begin(), line.end(), '\r', ' ');
  while (!line.empty() && (line.back() == ' ' || line.back() == '.')) line.pop_back();
  if (line.size() <= kLongest) return line;
  const auto within_character = [&](std::size_t at) { return (line[at] & 0xC0) == 0x80; };
  std::size_t begin = kLongest / 2, end = line.size() - kLongest / 2;
  while (within_character(begin)) --begin;
  while (within_character(end)) ++end;
  return line.replace(begin, end - begin, " ... ");
}

void keep(std::vector<std::string>& messages, const char* text) {
  if (messages.size() >= kMostMessages) return;
  std::string line = one_line(text);
  if (std::find(messages.begin(), messages.end(), line) == messages.end())
    messages.push_back(std::move(line));
}

}  // namespace

GdalSession::GdalSession() : messages_(std::make_unique<Messages>()) {
  static std::once_flag registered;
  std::call_once(registered, [] {
    GDALAllRegister();
    // The thread that GDAL gives a spatial index needs memory of its own, and waits without end where there
    // is little.
    CPLSetConfigOption("OGR_GPKG_ALLOW_THREADED_RTREE", "NO");
  });
  const auto handler = [](CPLErr severity, CPLErrorNum number, const char* text) {
    auto* messages = static_cast<Messages*>(CPLGetErrorHandlerUserData());
    if (severity == CE_Failure || severity == CE_Fatal) {
      keep(messages->errors, text);
      // SQLite's lack of memory is any error to GDAL.
      const bool said = std::string_view(text).find("out of memory") != std::string_view::npos;
      messages->memory_lacked = messages->memory_lacked || number == CPLE_OutOfMemory || said;
    }
    if (severity == CE_Warning) keep(messages->warnings, text);
  };
  messages_->outer = std::exchange(innermost, this);
  CPLPushErrorHandlerEx(handler, messages_.get());
  CPLErrorReset();
}

GdalSession::~GdalSession() {
  CPLPopErrorHandler();
  CPLErrorReset();
  innermost = messages_->outer;
  if (innermost == nullptr) return;
  for (const std::string& warning : messages_->warnings)
    keep(innermost->messages_->warnings, warning.c_str());
}

bool GdalSession::failed() const {
  return !messages_->errors.empty();
}

std::string GdalSession::reason() const {
  std::string words;
  for (const std::string& error : messages_->errors) words += (words.empty() ? "" : "; ") + error;
  return words.empty() ? words : " (" + words + ")";
}

void GdalSession::fail_to_write(const std::string& what, const char* remedy) const {
  if (messages_->memory_lacked) {
    throw Error(ErrorCode::OutOfMemory,
                what + reason() + "; there is not enough memory; nothing was written");
  }
  throw Error(ErrorCode::WriteFailed, what + reason() + "; " + remedy);
}

void GdalSession::reset() {
  messages_->errors.clear();
  messages_->memory_lacked = false;
  CPLErrorReset();
}

std::vector<std::string> GdalSession::take_warnings() {
  return std::exchange(messages_->warnings, {});
}

}  // namespace thalweg
