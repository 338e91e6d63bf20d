/* Number of the app in performance logs. */
#ifndef UPPER_APP_PERFIDS_H
#define UPPER_APP_PERFIDS_H

#define UPPER_APP_PERF_ID 94

#endif
