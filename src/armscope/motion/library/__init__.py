"""What may make torques differ from those of the model: causes in words and as laws, placed on an arm."""
