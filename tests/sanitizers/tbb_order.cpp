// For ThreadSanitizer: the order that TBB's scheduler keeps. Debian's libtbb is not instrumented, so the sanitizer does
// not see that what a thread wrote before it spawned a task, or passed an item down a pipeline, comes before what the
// task, or the next stage, reads; it would call every such pair a race. The functions of libtbb below take the place of
// its own in programs that link this file: they tell the sanitizer, and call the real ones. Nothing of ours is
// suppressed: two tasks that touch the same memory are still unordered, and reported.
#include <dlfcn.h>
#include <sanitizer/tsan_interface.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <cstdio>
#include <cstdlib>
#include <new>

// Runs before the order is known, so its own reads are not looked at.
#define BEFORE_ORDER __attribute__((no_sanitize("thread"), noinline))

namespace tbb::detail {
namespace {

/// libtbb's own function of that name, as the linker knows it.
template <class Function>
Function real(const char* name) {
    void* address = dlsym(RTLD_NEXT, name);
    if (address == nullptr) {
        std::fprintf(stderr, "tbb_order.cpp: libtbb has no %s: it is a version that this file does not know\n", name);
        std::abort();
    }
    return reinterpret_cast<Function>(address);
}

/// Tells the sanitizer at the end of a scope, however it ends: with an exception, too.
class ReleaseAtEnd {
public:
    explicit ReleaseAtEnd(void* place) : place_(place) {}
    ~ReleaseAtEnd() { __tsan_release(place_); }
    ReleaseAtEnd(const ReleaseAtEnd&) = delete;
    ReleaseAtEnd& operator=(const ReleaseAtEnd&) = delete;

private:
    void* place_;
};
class AcquireAtEnd {
public:
    explicit AcquireAtEnd(void* place) : place_(place) {}
    ~AcquireAtEnd() { __tsan_acquire(place_); }
    AcquireAtEnd(const AcquireAtEnd&) = delete;
    AcquireAtEnd& operator=(const AcquireAtEnd&) = delete;

private:
    void* place_;
};

/// A task that is spawned in another's place, runs it, and then goes away.
class OrderedTask final : public d1::task {
public:
    explicit OrderedTask(d1::task& inner) : inner_(&inner) { __tsan_release(this); }
    BEFORE_ORDER d1::task* execute(d1::execution_data& data) override {
        __tsan_acquire(this);
        return run(inner_->execute(data));
    }
    BEFORE_ORDER d1::task* cancel(d1::execution_data& data) override {
        __tsan_acquire(this);
        return run(inner_->cancel(data));
    }

private:
    d1::task* run(d1::task* next) {
        delete this;
        return next;
    }
    d1::task* inner_;
};

/// What an arena's thread calls for another thread.
class OrderedDelegate final : public d1::delegate_base {
public:
    explicit OrderedDelegate(d1::delegate_base& inner) : inner_(&inner) { __tsan_release(&begin_); }
    BEFORE_ORDER bool operator()() const override {
        __tsan_acquire(&begin_);
        const ReleaseAtEnd end(&end_);
        return (*inner_)();
    }
    void* end() { return &end_; }

private:
    d1::delegate_base* inner_;
    mutable char begin_ = 0, end_ = 0;
};

/// Comes before every stage of a pipeline, and after.
struct Ends {
    char begin = 0, end = 0;
};

/// A stage of a pipeline: comes after the stage before it of the same item, and if it is serial, after itself.
class OrderedFilter final : public d1::base_filter {
public:
    OrderedFilter(d1::base_filter* inner, Ends* ends)
        : base_filter((inner->is_serial() ? filter_is_serial : 0) |
                      (inner->is_serial() && !inner->is_ordered() ? filter_is_out_of_order : 0) |
                      (inner->object_may_be_null() ? filter_may_emit_null : 0)),
          inner_(inner),
          ends_(ends) {}
    ~OrderedFilter() override {
        inner_->~base_filter();
        r1::deallocate_memory(inner_);
    }
    BEFORE_ORDER void* operator()(void* item) override {
        __tsan_acquire(&ends_->begin);
        const ReleaseAtEnd end(&ends_->end);
        if (is_serial()) __tsan_acquire(this);
        if (item != nullptr) __tsan_acquire(item);
        running = this;
        void* result = (*inner_)(item);
        if (result != nullptr) __tsan_release(result);
        if (is_serial()) __tsan_release(this);
        return result;
    }
    BEFORE_ORDER void finalize(void* item) override {
        __tsan_acquire(item);
        inner_->finalize(item);
    }

    static thread_local OrderedFilter* running;  ///< the stage of this thread: the one that libtbb knows

private:
    d1::base_filter* inner_;
    Ends* ends_;
};
thread_local OrderedFilter* OrderedFilter::running = nullptr;

template <class T, class... Arguments>
T* make(Arguments... arguments) {
    return new (r1::allocate_memory(sizeof(T))) T(arguments...);
}

class OrderedLeaf final : public d1::filter_node {
public:
    OrderedLeaf(const d1::filter_node* inner, Ends* ends) : inner_(inner), ends_(ends) {}
    d1::base_filter* create_filter() const override { return make<OrderedFilter>(inner_->create_filter(), ends_); }

private:
    const d1::filter_node* inner_;
    Ends* ends_;
};

d1::filter_node* with_order(const d1::filter_node& node, Ends* ends) {
    auto* copy = make<OrderedLeaf>(&node, ends);
    if (!node.left) return copy;
    copy->left = with_order(*node.left, ends);
    copy->right = with_order(*node.right, ends);
    return copy;
}

}  // namespace

namespace r1 {

// Memory of tasks: libtbb's pools hand it on between threads, the sanitizer's own knows when it was freed.

void* allocate(d1::small_object_pool*& pool, std::size_t bytes, const d1::execution_data&) {
    return allocate(pool, bytes);
}
void* allocate(d1::small_object_pool*&, std::size_t bytes) {
    return ::operator new (bytes, std::align_val_t{d1::task_alignment});
}
void deallocate(d1::small_object_pool& pool, void* memory, std::size_t bytes, const d1::execution_data&) {
    deallocate(pool, memory, bytes);
}
void deallocate(d1::small_object_pool&, void* memory, std::size_t) {
    ::operator delete (memory, std::align_val_t{d1::task_alignment});
}

void spawn(d1::task& task, d1::task_group_context& context) {
    static const auto function = real<void (*)(d1::task&, d1::task_group_context&)>(
        "_ZN3tbb6detail2r15spawnERNS0_2d14taskERNS2_18task_group_contextE");
    function(*new OrderedTask(task), context);
}

void spawn(d1::task& task, d1::task_group_context& context, d1::slot_id slot) {
    static const auto function = real<void (*)(d1::task&, d1::task_group_context&, d1::slot_id)>(
        "_ZN3tbb6detail2r15spawnERNS0_2d14taskERNS2_18task_group_contextEt");
    function(*new OrderedTask(task), context, slot);
}

void execute_and_wait(d1::task& task, d1::task_group_context& context, d1::wait_context& wait,
                      d1::task_group_context& wait_group) {
    static const auto function =
        real<void (*)(d1::task&, d1::task_group_context&, d1::wait_context&, d1::task_group_context&)>(
            "_ZN3tbb6detail2r116execute_and_waitERNS0_2d14taskERNS2_18task_group_contextERNS2_12wait_contextES6_");
    function(task, context, wait, wait_group);
    wait.reserve(0);  // atomic: comes after every task's release of `wait`
}

void execute(d1::task_arena_base& arena, d1::delegate_base& delegate) {
    static const auto function = real<void (*)(d1::task_arena_base&, d1::delegate_base&)>(
        "_ZN3tbb6detail2r17executeERNS0_2d115task_arena_baseERNS2_13delegate_baseE");
    OrderedDelegate ordered(delegate);
    const AcquireAtEnd end(ordered.end());
    function(arena, ordered);
}

void parallel_pipeline(d1::task_group_context& context, std::size_t tokens, const d1::filter_node& stages) {
    static const auto function = real<void (*)(d1::task_group_context&, std::size_t, const d1::filter_node&)>(
        "_ZN3tbb6detail2r117parallel_pipelineERNS0_2d118task_group_contextEmRKNS2_11filter_nodeE");
    Ends ends;
    const d1::filter_node_ptr ordered(with_order(stages, &ends));
    __tsan_release(&ends.begin);
    const AcquireAtEnd end(&ends.end);
    function(context, tokens, *ordered);
}

void set_end_of_input(d1::base_filter&) {
    static const auto function =
        real<void (*)(d1::base_filter&)>("_ZN3tbb6detail2r116set_end_of_inputERNS0_2d111base_filterE");
    function(*OrderedFilter::running);
}

}  // namespace r1
}  // namespace tbb::detail
