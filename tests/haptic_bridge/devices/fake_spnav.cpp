// SPDX-License-Identifier: Apache-2.0
// A libspnav whose cap a test pushes. Two additional functions set what the library returns.
#include <deque>
#include <mutex>

namespace {

struct Event {
    int words[8];  // type, then x, y, z, rx, ry, rz or press, number
};
std::mutex mutex;
std::deque<Event> events;
bool daemonRuns = true;

}  // namespace

extern "C" {
int spnav_open() { return daemonRuns ? 0 : -1; }
int spnav_close() { return 0; }
int spnav_poll_event(Event* event) {
    const std::lock_guard lock(mutex);
    if (events.empty()) {
        return 0;
    }
    *event = events.front();
    events.pop_front();
    return event->words[0];
}
void fakeSpnavPush(int x, int y, int z) {
    const std::lock_guard lock(mutex);
    events.push_back({{1, x, y, z, 0, 0, 0, 0}});
}
void fakeSpnavButton(int number, int press) {
    const std::lock_guard lock(mutex);
    events.push_back({{2, press, number, 0, 0, 0, 0, 0}});
}
void fakeSpnavDaemon(int runs) { daemonRuns = runs != 0; }
}
