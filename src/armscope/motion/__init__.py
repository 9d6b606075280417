"""Arms in motion: when simulated and recorded torques differ, what was left out?"""
