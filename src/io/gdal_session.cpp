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
#include <utility>
#include <vector>

namespace thalweg {

struct GdalSession::Messages {
  std::vector<std::string> errors;
  std::vector<std::string> warnings;
  GdalSession* outer = nullptr;
};

namespace {

thread_local GdalSession* innermost = nullptr;

// A broken file can give a message a row: what is beyond these says nothing new.
constexpr std::size_t kMostMessages = 8;

std::string one_line(const char* text) {
  std::string line(text);
  std::replace(line.begin(), line.end(), '\n', ' ');
  std::replace(line.begin(), line.end(), '\r', ' ');
  while (!line.empty() && (line.back() == ' ' || line.back() == '.')) line.pop_back();
  return line;
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
  const auto handler = [](CPLErr severity, CPLErrorNum, const char* text) {
    auto* messages = static_cast<Messages*>(CPLGetErrorHandlerUserData());
    if (severity == CE_Failure || severity == CE_Fatal) keep(messages->errors, text);
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

void GdalSession::reset() {
  messages_->errors.clear();
  CPLErrorReset();
}

std::vector<std::string> GdalSession::take_warnings() {
  return std::exchange(messages_->warnings, {});
}

}  // namespace thalweg
