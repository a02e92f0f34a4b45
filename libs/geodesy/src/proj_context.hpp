#pragma once
#include <proj.h>
#include <proj_experimental.h>

#include <memory>
#include <string>

namespace priormap {

struct ProjDeleter {
  void operator()(PJ* object) const { proj_destroy(object); }
  void operator()(PJ_OBJ_LIST* list) const { proj_list_destroy(list); }
  void operator()(PJ_OPERATION_FACTORY_CONTEXT* factory) const { proj_operation_factory_context_destroy(factory); }
};
using ProjObject = std::unique_ptr<PJ, ProjDeleter>;
using ProjList = std::unique_ptr<PJ_OBJ_LIST, ProjDeleter>;
using ProjFactory = std::unique_ptr<PJ_OPERATION_FACTORY_CONTEXT, ProjDeleter>;

/// One thread's PROJ. Silent: what PROJ would print is kept as `last_message`. Must outlive the objects made with it.
class ProjContext {
 public:
  ProjContext() : context_(proj_context_create()) { proj_log_func(context_, &last_message_, keep_message); }
  ~ProjContext() { proj_context_destroy(context_); }
  ProjContext(const ProjContext&) = delete;
  ProjContext& operator=(const ProjContext&) = delete;

  /// For what does not outlive a function: each context opens PROJ's database anew, and keeps what it has read there.
  static const ProjContext& of_thread() {
    thread_local ProjContext context;
    context.last_message_.clear();
    return context;
  }

  operator PJ_CONTEXT*() const { return context_; }
  const std::string& last_message() const { return last_message_; }

 private:
  static void keep_message(void* kept, int, const char* message) { *static_cast<std::string*>(kept) = message; }
  PJ_CONTEXT* context_;
  std::string last_message_;
};

}  // namespace priormap
