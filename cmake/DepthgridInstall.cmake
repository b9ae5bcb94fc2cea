# Install rules; the package config is added here.
