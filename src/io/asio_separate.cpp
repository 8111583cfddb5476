// Asio's own functions, compiled once (BOOST_ASIO_SEPARATE_COMPILATION): its other users compile in half the time.
#include <boost/asio/impl/src.hpp>
