"""The sub-commands of this extension, a file each."""
