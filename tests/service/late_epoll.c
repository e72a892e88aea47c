/* To be preloaded: in the program reposed, a listening socket is taken out of an epoll set 0.1 s late. So whatever else takes it out
 * at that time comes between. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdlib.h>
#include <string.h>
#include <sys/epoll.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

int epoll_ctl(int set, int operation, int file, struct epoll_event *event)
{
    static int (*next)(int, int, int, struct epoll_event *);
    if (!next) next = (int (*)(int, int, int, struct epoll_event *))dlsym(RTLD_NEXT, "epoll_ctl");
    int listens = 0;
    socklen_t size = sizeof listens;
    if (operation == EPOLL_CTL_DEL && getsockopt(file, SOL_SOCKET, SO_ACCEPTCONN, &listens, &size) == 0 && listens)
        nanosleep(&(struct timespec){ .tv_nsec = 100000000 }, NULL);
    return next(set, operation, file, event);
}
