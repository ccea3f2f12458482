"""ROS 2 node around a shield that iiwa_dnn exported."""
