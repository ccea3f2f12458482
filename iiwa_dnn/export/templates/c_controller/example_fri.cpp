// A client of KUKA's Fast Robot Interface that moves the arm by the controller, in position control.
// It needs KUKA's FRI client SDK, in the folder SDK with its library built:
//     cc -O2 -c armstep.c @name@.c
//     c++ -O2 -I$SDK/include example_fri.cpp armstep.o @name@.o libFRIClient.a -o example_fri
#include <cmath>
#include <cstddef>  // the SDK's headers take NULL for granted
#include <stdexcept>

#include "@name@.h"
#include "friClientApplication.h"
#include "friLBRClient.h"
#include "friUdpConnection.h"

static_assert(@NAME@_JOINTS == KUKA::FRI::LBRState::NUMBER_OF_JOINTS, "an LBR arm has 7 joints");

class ControllerClient : public KUKA::FRI::LBRClient {
public:
    ControllerClient()
    {
        if (armstep_load(&arm_, &@name@) != ARMSTEP_OK) {
            throw std::runtime_error("the tables do not load");
        }
        armstep_begin(&arm_, memory_, scratch_);
    }

    // Called by the FRI at every sample while the robot may be commanded.
    void command() override
    {
        if (!started_) {
            // Where the robot is commanded to be: the measured position would be a small jump.
            const double *held = robotState().getIpoJointPosition();
            for (int i = 0; i < @NAME@_JOINTS; i++) {
                q_[i] = held[i];
            }
            started_ = true;
        }
        if (std::fabs(robotState().getSampleTime() - @name@.dt) > 1e-9) {
            last_action = ARMSTEP_INVALID;  // another sample time is another speed
            robotCommand().setJointPosition(q_);
            return;
        }
        double dq[@NAME@_JOINTS];
        const struct armstep_input input = {q_, ARMSTEP_REQUEST_NONE, @request_of_step@, t_, 0.0, 0.0};
        last_action = armstep_step(&arm_, memory_, scratch_, &input, dq);
        for (int i = 0; i < @NAME@_JOINTS; i++) {
            q_[i] += @name@.dt * dq[i];  // what was commanded, free of the encoders' noise
        }
        robotCommand().setJointPosition(q_);
        t_ += @name@.dt;
    }

    double target[ARMSTEP_TARGET * @NAME@_FRAMES] = {@target@};  // see README.md
    int last_action = 0;

private:
    struct armstep arm_;
    double memory_[@NAME@_MEMORY];
    double scratch_[@NAME@_SCRATCH];
    double q_[@NAME@_JOINTS] = {0.0};
    double t_ = 0.0;
    bool started_ = false;
};

int main()
{
    ControllerClient client;
    KUKA::FRI::UdpConnection connection;
    KUKA::FRI::ClientApplication application(connection, client);
    if (!application.connect(30200, nullptr)) {  // whichever robot sends to this port
        return 1;
    }
    while (application.step() && client.robotState().getSessionState() != KUKA::FRI::IDLE) {
    }
    application.disconnect();
    return client.last_action;
}
