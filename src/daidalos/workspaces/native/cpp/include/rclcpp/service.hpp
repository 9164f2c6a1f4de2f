// Services.
#ifndef RCLCPP__SERVICE_HPP_
#define RCLCPP__SERVICE_HPP_

#include <functional>
#include <memory>
#include <string>

#include "daidalos/cdr.hpp"
#include "daidalos/node_core.hpp"

struct rmw_request_id_t
{
  std::int8_t writer_guid[16] = {};
  std::int64_t sequence_number = 0;
};

namespace rclcpp
{
class ServiceBase : public daidalos::Entity
{
public:
  RCLCPP_SMART_PTR_DEFINITIONS(ServiceBase)
  ServiceBase(const char * type, const std::string & name, const QoS & qos) : type_(type), name_(name), qos_(qos) {}
  ~ServiceBase() override;
  void open(const daidalos::NodeCore & node, const CallbackGroup::SharedPtr & group);
  const char * get_service_name() {return name_.c_str();}
  bool run() override;

protected:
  virtual void handle(const std::shared_ptr<rmw_request_id_t> & header, const daidalos::Bytes & request) = 0;
  void answer(const rmw_request_id_t & header, const daidalos::Bytes & response);

private:
  const char * type_;
  std::string name_;
  QoS qos_;
  daidalos::Object service_;
};

/// Service whose callback fills the response, or answers later by send_response().
template<typename ServiceT>
class Service : public ServiceBase
{
public:
  RCLCPP_SMART_PTR_DEFINITIONS(Service)
  using Request = typename ServiceT::Request;
  using Response = typename ServiceT::Response;
  using RequestPtr = std::shared_ptr<Request>;
  using ResponsePtr = std::shared_ptr<Response>;
  using HeaderPtr = std::shared_ptr<rmw_request_id_t>;

  template<typename F>
  Service(const std::string & name, F callback, const QoS & qos) : ServiceBase(ServiceT::_SERVICE_NAME, name, qos)
  {
    using Self = std::shared_ptr<Service>;
    if constexpr (std::is_invocable<F &, RequestPtr, ResponsePtr>::value) {
      call_ = [callback](Service & self, HeaderPtr header, RequestPtr request) mutable {
          auto response = std::make_shared<Response>();
          callback(std::move(request), response);
          self.send_response(*header, *response);
        };
    } else if constexpr (std::is_invocable<F &, HeaderPtr, RequestPtr, ResponsePtr>::value) {
      call_ = [callback](Service & self, HeaderPtr header, RequestPtr request) mutable {
          auto response = std::make_shared<Response>();
          callback(header, std::move(request), response);
          self.send_response(*header, *response);
        };
    } else if constexpr (std::is_invocable<F &, HeaderPtr, RequestPtr>::value) {
      call_ = [callback](Service &, HeaderPtr header, RequestPtr request) mutable {
          callback(std::move(header), std::move(request));
        };
    } else {
      static_assert(std::is_invocable<F &, Self, HeaderPtr, RequestPtr>::value,
        "the callback of a service takes (request, response), (header, request, response), (header, request) or "
        "(service, header, request), all as shared pointers");
      call_ = [callback](Service & self, HeaderPtr header, RequestPtr request) mutable {
          callback(std::static_pointer_cast<Service>(self.shared_from_this()), std::move(header), std::move(request));
        };
    }
  }
  void send_response(rmw_request_id_t & header, Response & response)
  {
    daidalos::Bytes data;
    daidalos::encode(response, data);
    answer(header, data);
  }

private:
  void handle(const HeaderPtr & header, const daidalos::Bytes & data) override
  {
    auto request = std::make_shared<Request>();
    daidalos::decode(data, *request);
    call_(*this, header, std::move(request));
  }
  std::function<void(Service &, HeaderPtr, RequestPtr)> call_;
};
}  // namespace rclcpp
#endif
