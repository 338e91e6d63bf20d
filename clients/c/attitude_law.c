/* The law of scenarios/earth-observer.toml as a control program: the acceleration about each axis that gives the attitude
 * error a bandwidth and a damping ratio, plus that of the reference.
 *
 *     flexsc serve scenarios/earth-observer.toml
 *     clients/c/attitude_law
 *
 * Its commands are those of `[law.attitude]` to the last bit, if the compiler does not contract products and sums
 * (-ffp-contract=off). Arguments: host, port, and `tcp` for a server with `--tcp`. */
#include "flexsc_lockstep.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static flexsc_client client;

int main(int count, char **arguments)
{
    const char *host = count > 1 ? arguments[1] : "127.0.0.1";
    const uint16_t port = (uint16_t)(count > 2 ? strtoul(arguments[2], NULL, 10) : 5010);
    const int transport = count > 3 && strcmp(arguments[3], "tcp") == 0 ? FLEXSC_TCP : FLEXSC_UDP;
    const double bandwidth = 0.1; /* rad/s */
    const double damping = 0.8;
    if (flexsc_connect(&client, transport, host, port, 0) != 0) {
        fprintf(stderr, "error: %s\n", client.error);
        return 1;
    }
    const int error = flexsc_find(&client, "estimate.error");
    const int rate = flexsc_find(&client, "estimate.rate");
    const int reference_angle = flexsc_find(&client, "reference.angle");
    const int reference_rate = flexsc_find(&client, "reference.rate");
    const int acceleration = flexsc_find(&client, "reference.acceleration");
    if (error < 0) {
        fprintf(stderr, "error: the scenario has no attitude error: its body has one axis\n");
        return 1;
    }
    const double gain = 2.0 * damping * bandwidth;
    int status;
    while ((status = flexsc_receive(&client)) == 1) {
        double command[3];
        for (int axis = 0; axis < 3; axis++) {
            const double angle = flexsc_number(&client, error, axis) - flexsc_number(&client, reference_angle, axis);
            const double off = flexsc_number(&client, rate, axis) - flexsc_number(&client, reference_rate, axis);
            command[axis] = -(bandwidth * bandwidth * angle + gain * off) + flexsc_number(&client, acceleration, axis);
        }
        if (flexsc_command(&client, command, FLEXSC_ACCELERATION) != 0) {
            status = -1;
            break;
        }
    }
    if (status < 0) {
        fprintf(stderr, "error: %s\n", client.error);
    } else {
        printf("%llu cycles, %s\n", (unsigned long long)client.cycle + 1,
               client.end == FLEXSC_COMPLETE ? "complete" : client.end == FLEXSC_FAILED ? "failed" : "interrupted");
    }
    flexsc_close(&client);
    return status < 0 || client.end == FLEXSC_FAILED;
}
