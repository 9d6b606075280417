"""What breaks software on purpose: kills, full disks, too little memory, two of everything, other machines."""
